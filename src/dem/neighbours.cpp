#include "dem/neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dem/blocks.hpp"

namespace ejecta {
namespace {

constexpr int kSearchBlock = 256;  // items searched by one thread at a time
constexpr double kLarge = 3.0;     // times the median radius
constexpr std::size_t kMostLarge = 1000;

}  // namespace

/// Cells as wide as the largest item hold so many small ones that all would be compared with all.
void NeighbourSearch::set_large_apart(const std::vector<Item>& items) {
  radii_.clear();
  for (const Item& item : items) radii_.push_back(item.radius);
  const auto median = radii_.begin() + static_cast<std::ptrdiff_t>(radii_.size() / 2);
  std::nth_element(radii_.begin(), median, radii_.end());
  const double limit = kLarge * *median;
  small_.clear();
  large_.clear();
  for (std::size_t n = 0; n < items.size(); ++n)
    (items[n].radius > limit ? large_ : small_).push_back(static_cast<int>(n));
  if (large_.size() > kMostLarge) {
    large_.clear();
    small_.resize(items.size());
    std::iota(small_.begin(), small_.end(), 0);
  }
  largest_small_ = 0.0;
  for (const int n : small_)
    largest_small_ = std::max(largest_small_, items[static_cast<std::size_t>(n)].radius);
}

/// Pairs of the n-th large item with all small ones and with the large ones after it.
void NeighbourSearch::find_of_large(const std::vector<Item>& items, std::size_t n, double reach,
                                    std::vector<std::pair<int, int>>& pairs) const {
  const int i = large_[n];
  const Item& item = items[static_cast<std::size_t>(i)];
  const auto note = [&](const Vec3& centre, double radius, int body, int j) {
    const double limit = item.radius + radius + reach;
    if (body != item.body && (centre - item.centre).squaredNorm() < limit * limit)
      pairs.emplace_back(std::min(i, j), std::max(i, j));
  };
  int from[3], to[3];
  const double far = item.radius + largest_small_ + reach;
  for (int c = 0; c < 3; ++c) {
    const double at = item.centre[c] - lattice_.origin[c], last = lattice_.n[c] - 1;
    from[c] = static_cast<int>(std::clamp(std::floor((at - far) / lattice_.edge), 0.0, last));
    to[c] = static_cast<int>(std::clamp(std::floor((at + far) / lattice_.edge), 0.0, last));
  }
  for (int z = from[2]; z <= to[2]; ++z)
    for (int y = from[1]; y <= to[1]; ++y) {
      const int row = (z * lattice_.n[1] + y) * lattice_.n[0];
      for (int p = first_[static_cast<std::size_t>(row + from[0])];
           p < first_[static_cast<std::size_t>(row + to[0]) + 1]; ++p) {
        const Sorted& other = sorted_[static_cast<std::size_t>(p)];
        note({other.x, other.y, other.z}, other.radius, other.body, other.index);
      }
    }
  for (std::size_t m = n + 1; m < large_.size(); ++m) {
    const Item& other = items[static_cast<std::size_t>(large_[m])];
    note(other.centre, other.radius, other.body, large_[m]);
  }
}

void NeighbourSearch::sort_into_cells(const std::vector<Item>& items, double edge) {
  const auto item_of = [&](std::size_t n) -> const Item& {
    return items[static_cast<std::size_t>(small_[n])];
  };
  Vec3 low = item_of(0).centre, high = low;
  for (std::size_t n = 0; n < small_.size(); ++n) {
    low = low.cwiseMin(item_of(n).centre);
    high = high.cwiseMax(item_of(n).centre);
  }
  const Vec3 size = high - low;
  // Bodies that fly far apart must not cost memory: at most about 8 cells an item.
  const double most = 8.0 * static_cast<double>(small_.size()) + 64.0;
  while ((size / edge).array().floor().cwiseMin(1e9).unaryExpr([](double v) { return v + 1; }).prod() > most)
    edge *= 1.3;
  for (auto* v : {&first_, &cursor_}) v->reserve(static_cast<std::size_t>(most) + 1);
  lattice_.origin = low;
  lattice_.edge = edge;
  for (int c = 0; c < 3; ++c) lattice_.n[c] = static_cast<int>(size[c] / edge) + 1;

  const std::size_t cells = static_cast<std::size_t>(lattice_.n[0]) * lattice_.n[1] * lattice_.n[2];
  first_.assign(cells + 1, 0);
  cell_of_.resize(small_.size());
  for (std::size_t n = 0; n < small_.size(); ++n) {
    const Vec3 at = (item_of(n).centre - low) / edge;
    cell_of_[n] = (static_cast<int>(at.z()) * lattice_.n[1] + static_cast<int>(at.y())) * lattice_.n[0] +
                  static_cast<int>(at.x());
    ++first_[static_cast<std::size_t>(cell_of_[n]) + 1];
  }
  for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
  cursor_.assign(first_.begin(), first_.end());
  sorted_.resize(small_.size());
  for (std::size_t n = 0; n < small_.size(); ++n) {
    const Item& item = item_of(n);
    sorted_[static_cast<std::size_t>(cursor_[static_cast<std::size_t>(cell_of_[n])]++)] = {
        item.centre.x(), item.centre.y(), item.centre.z(), item.radius, item.body, small_[n], cell_of_[n]};
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
  set_large_apart(items);
  sort_into_cells(items, 2 * largest_small_ + reach);

  const int count = static_cast<int>(small_.size()), blocks = block_count(count, kSearchBlock);
  const std::size_t lists = static_cast<std::size_t>(blocks) + (large_.empty() ? 0 : 1);
  if (found_.size() < lists) found_.resize(lists);
  for (Found& found : found_) found.pairs.clear();
  for (std::size_t n = 0; n < large_.size(); ++n) find_of_large(items, n, reach, found_[lists - 1].pairs);
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
  sort_pairs(static_cast<int>(items.size()));
  return pairs_;
}

}  // namespace ejecta
