#include "coupling/unresolved/grain_map.hpp"

#include <cmath>

namespace ejecta {

GrainMap::GrainMap(const Grid& grid, const std::array<std::array<Beyond, 2>, 3>& beyond, double kernel_width)
    : grid_(grid), beyond_(beyond), kernel_width_(kernel_width) {
  for (int d = 0; d < 3; ++d)
    for (const double w : grid.axis(d).width) inverse_widths_[static_cast<std::size_t>(d)].push_back(1 / w);
}

void GrainMap::place(std::span<const Body> grains, const std::vector<char>& here,
                     std::span<const double> diameters, const CutCells& cut) {
  cells_.resize(grains.size(), {0, 0, 0});
  note_room(cut);
  sort_grains(grains, here);
  place_grains(grains, diameters);
}

/// Cells whose fluid is carried by another have no velocity of their own, nor have cells in bodies.
void GrainMap::note_room(const CutCells& cut) {
  bodies_ = !cut.empty();
  if (!bodies_) return;
  around_ = {grid_.nx(), 0, grid_.ny(), 0, grid_.nz(), 0};
  const auto include = [&](int i, int j, int k) {
    around_ = {std::min(around_.i0, i),     std::max(around_.i1, i + 1), std::min(around_.j0, j),
               std::max(around_.j1, j + 1), std::min(around_.k0, k),     std::max(around_.k1, k + 1)};
  };
  if (room_.size() == 0) room_ = grid_.make_field();
  room_.fill(1);
  for (const GhostCell& g : cut.ghosts) {
    room_(g.i, g.j, g.k) = 0;
    include(g.i, g.j, g.k);
  }
  for (std::size_t n = 0; n < cut.cells.size(); ++n) {
    const CutCell& c = cut.cells[n];
    include(c.i, c.j, c.k);
    room_(c.i, c.j, c.k) = c.locked || c.carrier != static_cast<int>(n) ? Real(0) : c.carried;
  }
}

/// Counting sort: the grains of a row stand in their order.
void GrainMap::sort_grains(std::span<const Body> grains, const std::vector<char>& here) {
  for_each_grain_block(grains.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n)
      for (int d = 0; here[n] && d < 3; ++d) {
        int& cell = cells_[n][static_cast<std::size_t>(d)];
        cell = cell_from(grid_.axis(d), grains[n].position[d], cell);
      }
  });
  const auto row_of = [&](std::size_t n) {
    return static_cast<std::size_t>(cells_[n][2] * grid_.ny() + cells_[n][1]);
  };
  first_of_row_.assign(static_cast<std::size_t>(grid_.ny() * grid_.nz()) + 1, 0);
  for (std::size_t n = 0; n < grains.size(); ++n)
    if (here[n]) ++first_of_row_[row_of(n) + 1];
  for (std::size_t r = 1; r < first_of_row_.size(); ++r) first_of_row_[r] += first_of_row_[r - 1];
  listed_.resize(static_cast<std::size_t>(first_of_row_.back()));
  std::vector<int> next(first_of_row_.begin(), first_of_row_.end() - 1);
  for (std::size_t n = 0; n < grains.size(); ++n)
    if (here[n]) listed_[static_cast<std::size_t>(next[row_of(n)]++)] = static_cast<int>(n);
}

/// A kernel that covers more cells than there is room for makes room, once and for all.
void GrainMap::place_grains(std::span<const Body> grains, std::span<const double> diameters) {
  places_.resize(listed_.size());
  std::vector<std::array<int, 2>> most(block_count_of(listed_.size()));  // cells, planes
  for (std::size_t wanted = stride_;; stride_ = wanted) {
    weights_.resize(3 * stride_ * listed_.size());
    for_each_grain_block(listed_.size(), [&](std::size_t b, std::size_t begin, std::size_t end) {
      most[b] = {0, 0};
      for (std::size_t at = begin; at < end; ++at) {
        const std::size_t later = grain_ahead(at, end - 1), n = grain(at);
        __builtin_prefetch(&grains[later].position);
        __builtin_prefetch(&cells_[later]);
        const int cells = place_one(grains[n].position, cells_[n], kernel_width_ * diameters[n], at),
                  first = places_[at].first[2], home = cells_[n][2];
        most[b][0] = std::max(most[b][0], cells);
        most[b][1] = std::max({most[b][1], home - first, first + places_[at].count[2] - 1 - home});
      }
    });
    reach_ = 0;
    for (const auto& [cells, planes] : most) {
      wanted = std::max(wanted, static_cast<std::size_t>((cells + kRun - 1) / kRun * kRun));
      reach_ = std::max(reach_, planes);
    }
    if (wanted == stride_) return;
  }
}

/// Returns over how many cells the grain spreads along an axis.
int GrainMap::place_one(const Vec3& position, const std::array<int, 3>& home, double width, std::size_t at) {
  Place& p = places_[at];
  double spread = 0;
  int most = 0;
  p.density = p.inside = 1;
  for (std::size_t d = 0; d < 3; ++d) {
    const Axis& axis = grid_.axis(static_cast<int>(d));
    const int cell = home[d];
    const double x = position[static_cast<int>(d)], h = kernel_half_width(axis, x, width, cell),
                 size = axis.width[static_cast<std::size_t>(cell)];
    const AxisWeights w = axis_weights(axis, x, h, beyond_[d], cell);
    spread += (h * h / 7 + size * size / 12) / 3;  // variance of the kernel and of a cell
    double sum = 0, squares = 0;
    for (int c = 0; c < w.count; ++c) {
      const double weight = w.weight[static_cast<std::size_t>(c)];
      sum += weight;
      squares += weight * weight *
                 inverse_widths_[d][static_cast<std::size_t>(wrapped(w.first + c, static_cast<int>(d)))];
    }
    p.inside *= sum;
    p.density *= squares;
    p.first[d] = w.first;
    p.count[d] = w.count;
    most = std::max(most, w.count);
    if (static_cast<std::size_t>(w.count) > stride_) continue;
    Real* to = weights_.data() + (3 * at + d) * stride_;
    for (std::size_t c = 0; c < stride_; ++c)
      to[c] = c < w.weight.size() ? static_cast<Real>(w.weight[c]) : Real(0);
  }
  p.spread = std::sqrt(spread);
  p.scale = p.inside > 0;
  p.near_bodies = false;
  if (!(p.inside > 0)) {
    p.inside = 0;
    p.count = {0, 0, 0};
  } else if (static_cast<std::size_t>(most) <= stride_) {
    take_whole_runs(p, weights_.data() + 3 * at * stride_);
    if (bodies_) place_near_bodies(at);
  }
  return most;
}

/// Rows begin farther from the end of the box where a run would go beyond it.
void GrainMap::take_whole_runs(Place& p, Real* along) const {
  const int whole = (p.count[0] + kRun - 1) / kRun * kRun, nx = grid_.nx();
  p.in_pieces = p.first[0] < 0 || p.first[0] + p.count[0] > nx || whole > nx;
  if (p.in_pieces) return;
  const int back = std::max(p.first[0] + whole - nx, 0);
  std::rotate(along, along + whole - back, along + whole);
  p.first[0] -= back;
  p.count[0] = whole;
}

/// Near bodies the fluid around them takes what would lie inside. Bodies do not cross periodic sides.
void GrainMap::place_near_bodies(std::size_t at) {
  Place& p = places_[at];
  const int low[3] = {around_.i0, around_.j0, around_.k0}, high[3] = {around_.i1, around_.j1, around_.k1};
  for (std::size_t d = 0; d < 3; ++d)
    if (p.first[d] >= high[d] || p.first[d] + p.count[d] <= low[d]) return;
  const double open = gather<1>(at, {room_.view()})[0];
  p.near_bodies = true;
  if (open > 1e-9 * p.inside && open > 0) {
    p.scale = static_cast<Real>(p.inside / open);
  } else {
    p.inside = 0;
    p.count = {0, 0, 0};
  }
}

double GrainMap::integral(ConstFieldView f) const {
  return reduce_sum(grid_.range(), [&](int i, int j, int k) {
    return double(f(i, j, k)) * grid_.volume(i, j, k) * (bodies_ ? double(room_(i, j, k)) : 1.0);
  });
}

}  // namespace ejecta
