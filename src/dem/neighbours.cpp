#include "dem/neighbours.hpp"

#include <algorithm>
#include <cmath>

#include "dem/blocks.hpp"

namespace ejecta {
namespace {

constexpr int kBlock = 256;  // items searched by one thread at a time

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
  lattice_.origin = low;
  lattice_.edge = edge;
  for (int c = 0; c < 3; ++c) lattice_.n[c] = static_cast<int>(size[c] / edge) + 1;

  first_.assign(static_cast<std::size_t>(lattice_.n[0]) * lattice_.n[1] * lattice_.n[2] + 1, 0);
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
  for (std::size_t n = 0; n < items.size(); ++n)
    sorted_[static_cast<std::size_t>(cursor_[static_cast<std::size_t>(cell_of_[n])]++)] = {
        items[n], static_cast<int>(n)};
}

void NeighbourSearch::neighbours_of(const std::vector<Item>& items, int i, double reach,
                                    std::vector<std::pair<int, int>>& out) const {
  const Item& item = items[static_cast<std::size_t>(i)];
  const int cell = cell_of_[static_cast<std::size_t>(i)];
  const int nx = lattice_.n[0], ny = lattice_.n[1], nz = lattice_.n[2];
  const int cx = cell % nx, cy = cell / nx % ny, cz = cell / (nx * ny);
  const std::size_t start = out.size();
  for (int z = std::max(cz - 1, 0); z <= std::min(cz + 1, nz - 1); ++z)
    for (int y = std::max(cy - 1, 0); y <= std::min(cy + 1, ny - 1); ++y) {
      const std::size_t row = static_cast<std::size_t>(z * ny + y) * static_cast<std::size_t>(nx);
      const int from = first_[row + static_cast<std::size_t>(std::max(cx - 1, 0))];
      const int to = first_[row + static_cast<std::size_t>(std::min(cx + 1, nx - 1)) + 1];
      for (int n = from; n < to; ++n) {
        const Sorted& other = sorted_[static_cast<std::size_t>(n)];
        const double limit = item.radius + other.item.radius + reach;
        if (other.index > i && (other.item.centre - item.centre).squaredNorm() < limit * limit &&
            other.item.body != item.body)
          out.emplace_back(i, other.index);
      }
    }
  std::sort(out.begin() + static_cast<std::ptrdiff_t>(start), out.end());
}

const std::vector<std::pair<int, int>>& NeighbourSearch::find(const std::vector<Item>& items, double reach) {
  pairs_.clear();
  if (items.size() < 2) return pairs_;
  double largest = 0.0;
  for (const Item& item : items) largest = std::max(largest, item.radius);
  sort_into_cells(items, 2 * largest + reach);

  const int count = static_cast<int>(items.size()), blocks = block_count(count, kBlock);
  if (found_.size() < static_cast<std::size_t>(blocks)) found_.resize(static_cast<std::size_t>(blocks));
  for_each_block(count, kBlock, [&](int b, int begin, int end) {
    auto& out = found_[static_cast<std::size_t>(b)];
    out.clear();
    for (int i = begin; i < end; ++i) neighbours_of(items, i, reach, out);
  });
  for (int b = 0; b < blocks; ++b) {
    const auto& out = found_[static_cast<std::size_t>(b)];
    pairs_.insert(pairs_.end(), out.begin(), out.end());
  }
  return pairs_;
}

}  // namespace ejecta
