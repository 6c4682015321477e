#include "dem/neighbours.hpp"

#include <algorithm>
#include <cmath>

#include "dem/blocks.hpp"

namespace ejecta {
namespace {

constexpr int kSearchBlock = 256;  // items searched by one thread at a time

}  // namespace

void NeighbourSearch::sort_into_cells(const std::vector<Item>& items, double edge) {
  Vec3 low = items.front().centre, high = low;
  for (const Item& item : items) {
    low = low.cwiseMin(item.centre);
    high = high.cwiseMax(item.centre);
  }
  const Vec3 size = high - low;
  // Bodies that fly far apart must not cost memory: at most about 8 cells an item.
  const double most = 8.0 * static_cast<double>(items.size()) + 64.0;
  while ((size / edge).array().floor().cwiseMin(1e9).unaryExpr([](double v) { return v + 1; }).prod() > most)
    edge *= 1.3;
  for (auto* v : {&first_, &cursor_}) v->reserve(static_cast<std::size_t>(most) + 1);
  lattice_.origin = low;
  lattice_.edge = edge;
  for (int c = 0; c < 3; ++c) lattice_.n[c] = static_cast<int>(size[c] / edge) + 1;

  const std::size_t cells = static_cast<std::size_t>(lattice_.n[0]) * lattice_.n[1] * lattice_.n[2];
  first_.assign(cells + 1, 0);
  cell_of_.resize(items.size());
  for (std::size_t n = 0; n < items.size(); ++n) {
    const Vec3 at = (items[n].centre - low) / edge;
    cell_of_[n] = (static_cast<int>(at.z()) * lattice_.n[1] + static_cast<int>(at.y())) * lattice_.n[0] +
                  static_cast<int>(at.x());
    ++first_[static_cast<std::size_t>(cell_of_[n]) + 1];
  }
  for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
  cursor_.assign(first_.begin(), first_.end());
  sorted_.resize(items.size());
  for (std::size_t n = 0; n < items.size(); ++n) {
    const Item& item = items[n];
    sorted_[static_cast<std::size_t>(cursor_[static_cast<std::size_t>(cell_of_[n])]++)] = {
        item.centre.x(), item.centre.y(),     item.centre.z(), item.radius,
        item.body,       static_cast<int>(n), cell_of_[n]};
  }
}

std::size_t NeighbourSearch::neighbours_after(int p, double reach, std::vector<int>& near) const {
  const Sorted& item = sorted_[static_cast<std::size_t>(p)];
  const int nx = lattice_.n[0], ny = lattice_.n[1], nz = lattice_.n[2];
  const int cx = item.cell % nx, cy = item.cell / nx % ny, cz = item.cell / (nx * ny);
  const int left = std::max(cx - 1, 0), right = std::min(cx + 1, nx - 1);
  std::size_t count = 0;
  // A miss costs less than a branch that goes either way: every candidate is written, the near ones count.
  const auto look = [&](int from, int to) {
    if (near.size() < count + static_cast<std::size_t>(to - from))
      near.resize(2 * count + static_cast<std::size_t>(to - from));
    int* out = near.data();
    for (int q = from; q < to; ++q) {
      const Sorted& other = sorted_[static_cast<std::size_t>(q)];
      const double dx = other.x - item.x, dy = other.y - item.y, dz = other.z - item.z;
      const double limit = item.radius + other.radius + reach;
      out[count] = q;
      count += (dx * dx + dy * dy + dz * dz < limit * limit) & (other.body != item.body);
    }
  };
  const auto row = [&](int y, int z) { return first_.data() + (z * ny + y) * nx; };
  look(p + 1, row(cy, cz)[right + 1]);
  if (cy + 1 < ny) look(row(cy + 1, cz)[left], row(cy + 1, cz)[right + 1]);
  if (cz + 1 < nz)
    for (int y = std::max(cy - 1, 0); y <= std::min(cy + 1, ny - 1); ++y)
      look(row(y, cz + 1)[left], row(y, cz + 1)[right + 1]);
  return count;
}

/// All that the blocks found, by first and second item: counted, dealt out, and each item's few put in order.
void NeighbourSearch::sort_pairs(int items) {
  cursor_.assign(static_cast<std::size_t>(items) + 1, 0);
  for (const Found& found : found_)
    for (const auto& pair : found.pairs) ++cursor_[static_cast<std::size_t>(pair.first) + 1];
  for (std::size_t n = 1; n < cursor_.size(); ++n) cursor_[n] += cursor_[n - 1];
  pairs_.resize(static_cast<std::size_t>(cursor_.back()));
  for (const Found& found : found_)
    for (const auto& pair : found.pairs)
      pairs_[static_cast<std::size_t>(cursor_[static_cast<std::size_t>(pair.first)]++)] = pair;
  auto begin = pairs_.begin();
  for (int n = 0; n < items; ++n) {
    const auto end = pairs_.begin() + cursor_[static_cast<std::size_t>(n)];
    std::sort(begin, end);
    begin = end;
  }
}

const std::vector<std::pair<int, int>>& NeighbourSearch::find(const std::vector<Item>& items, double reach) {
  pairs_.clear();
  if (items.size() < 2) return pairs_;
  double largest = 0.0;
  for (const Item& item : items) largest = std::max(largest, item.radius);
  sort_into_cells(items, 2 * largest + reach);

  const int count = static_cast<int>(items.size()), blocks = block_count(count, kSearchBlock);
  if (found_.size() < static_cast<std::size_t>(blocks)) found_.resize(static_cast<std::size_t>(blocks));
  for (Found& found : found_) found.pairs.clear();
  for_each_block(count, kSearchBlock, [&](int b, int begin, int end) {
    Found& out = found_[static_cast<std::size_t>(b)];
    for (int p = begin; p < end; ++p) {
      const int i = sorted_[static_cast<std::size_t>(p)].index;
      const std::size_t near = neighbours_after(p, reach, out.near);
      for (std::size_t k = 0; k < near; ++k) {
        const int j = sorted_[static_cast<std::size_t>(out.near[k])].index;
        out.pairs.emplace_back(std::min(i, j), std::max(i, j));
      }
    }
  });
  sort_pairs(count);
  return pairs_;
}

}  // namespace ejecta
