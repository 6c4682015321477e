#include "coupling/unresolved/unresolved.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.hpp"
#include "base/state_reader.hpp"

namespace ejecta {
namespace {

constexpr int kGrainBlock = 256;    // grains one thread takes at a time
constexpr std::size_t kAhead = 12;  // grains: bodies lie far apart in memory and are asked for in time

/// Numbers of a run of cells, at any address.
using RealRun = Real __attribute__((vector_size(4 * sizeof(Real)), aligned(alignof(Real)), may_alias));
using DoubleRun =
    double __attribute__((vector_size(4 * sizeof(double)), aligned(alignof(double)), may_alias));

EJECTA_KERNEL RealRun run_at(const Real* cells) { return *reinterpret_cast<const RealRun*>(cells); }

EJECTA_KERNEL double sum_of(const RealRun& r) {
  return (double(r[0]) + double(r[1])) + (double(r[2]) + double(r[3]));
}

/// kernel(block, begin, end) for blocks of a list of grains.
template <class Kernel>
void for_each_grain_block(std::size_t count, const Kernel& kernel) {
  const int n = static_cast<int>(count), blocks = (n + kGrainBlock - 1) / kGrainBlock;
  for_each_index(blocks, [&](int b) {
    kernel(static_cast<std::size_t>(b), static_cast<std::size_t>(b * kGrainBlock),
           static_cast<std::size_t>(std::min((b + 1) * kGrainBlock, n)));
  });
}

std::size_t block_count_of(std::size_t grains) { return (grains + kGrainBlock - 1) / kGrainBlock; }

}  // namespace

UnresolvedCoupling::UnresolvedCoupling(const Grid& grid, const UnresolvedSetup& setup)
    : grid_(grid), setup_(setup) {
  for (int d = 0; d < 3; ++d)
    for (const double w : grid.axis(d).width) inverse_widths_[static_cast<std::size_t>(d)].push_back(1 / w);
}

/// visit(j, k, weight) for the rows of cells in plane number `plane` of a grain's own.
template <class Visit>
void UnresolvedCoupling::for_each_row(std::size_t at, int plane, const Visit& visit) const {
  const Place& p = places_[at];
  const Real *along_y = weights(at, 1), of_plane = p.scale * weights(at, 2)[plane];
  const int k = wrapped(p.first[2] + plane, 2);
  for (int b = 0; b < p.count[1]; ++b) visit(wrapped(p.first[1] + b, 1), k, of_plane * along_y[b]);
}

/// Sums of weight * field over the cells of a grain.
template <std::size_t kN>
std::array<double, kN> UnresolvedCoupling::gather(std::size_t at,
                                                  const std::array<ConstFieldView, kN>& fields) const {
  const Place& p = places_[at];
  if (p.in_pieces) return gather_in_pieces<kN>(at, fields);
  const Real *along = weights(at, 0), *room = p.near_bodies ? room_.view().origin : nullptr;
  RealRun sums[kN] = {};
  for (int plane = 0; plane < p.count[2]; ++plane)
    for_each_row(at, plane, [&](int j, int k, Real w) {
      std::ptrdiff_t cell = p.first[0] + j * fields[0].sy + k * fields[0].sz;
      for (int a = 0; a < p.count[0]; a += kRun, cell += kRun) {
        RealRun weight = w * run_at(along + a);
        if (room) weight *= run_at(room + cell);
        for (std::size_t c = 0; c < kN; ++c) sums[c] += weight * run_at(fields[c].origin + cell);
      }
    });
  std::array<double, kN> out;
  for (std::size_t c = 0; c < kN; ++c) out[c] = sum_of(sums[c]);
  return out;
}

/// Cell by cell, for rows that go on at the other end of the box, or are shorter than a run.
template <std::size_t kN>
std::array<double, kN> UnresolvedCoupling::gather_in_pieces(
    std::size_t at, const std::array<ConstFieldView, kN>& fields) const {
  const Place& p = places_[at];
  std::array<double, kN> sums{};
  for (int plane = 0; plane < p.count[2]; ++plane)
    for_each_row(at, plane, [&](int j, int k, Real w) {
      for (int a = 0; a < p.count[0]; ++a) {
        const int i = wrapped(p.first[0] + a, 0);
        const Real weight = w * weights(at, 0)[a] * (p.near_bodies ? room_(i, j, k) : Real(1));
        for (std::size_t c = 0; c < kN; ++c) sums[c] += double(weight * fields[c](i, j, k));
      }
    });
  return sums;
}

/// Cells whose fluid is carried by another have no velocity of their own, nor have cells in bodies.
void UnresolvedCoupling::note_room(const CutCells& cut) {
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

void UnresolvedCoupling::note_grains(std::span<const Body> grains) {
  for (std::size_t n = diameters_.size(); n < grains.size(); ++n) {
    diameters_.push_back(2 * grains[n].shape.bounding_radius());
    volumes_.push_back(grains[n].shape.mass_properties().volume);
    masses_.push_back(grains[n].mass);
  }
  cells_.resize(grains.size(), {0, 0, 0});
  pushed_.resize(grains.size(), Vec3(0, 0, 0));
}

/// Counting sort: the grains of a row stand in their order.
void UnresolvedCoupling::sort_grains(std::span<const Body> grains, const std::vector<char>& here) {
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
void UnresolvedCoupling::place_grains(std::span<const Body> grains) {
  places_.resize(listed_.size());
  std::vector<std::array<int, 2>> most(block_count_of(listed_.size()));  // cells, planes
  for (std::size_t wanted = stride_;; stride_ = wanted) {
    weights_.resize(3 * stride_ * listed_.size());
    for_each_grain_block(listed_.size(), [&](std::size_t b, std::size_t begin, std::size_t end) {
      most[b] = {0, 0};
      for (std::size_t at = begin; at < end; ++at) {
        const std::size_t later = static_cast<std::size_t>(listed_[std::min(at + kAhead, end - 1)]);
        __builtin_prefetch(&grains[later].position);
        __builtin_prefetch(&cells_[later]);
        const int grain = places_[at].grain = listed_[at];
        const int cells = place(grains[static_cast<std::size_t>(grain)], at), first = places_[at].first[2],
                  home = cells_[static_cast<std::size_t>(grain)][2];
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
int UnresolvedCoupling::place(const Body& grain, std::size_t at) {
  Place& p = places_[at];
  const std::size_t n = static_cast<std::size_t>(p.grain);
  const double width = setup_.kernel_width * diameters_[n];
  double spread = 0;
  int most = 0;
  p.density = p.inside = 1;
  for (std::size_t d = 0; d < 3; ++d) {
    const Axis& axis = grid_.axis(static_cast<int>(d));
    const int cell = cells_[n][d];
    const double x = grain.position[static_cast<int>(d)], h = kernel_half_width(axis, x, width, cell),
                 size = axis.width[static_cast<std::size_t>(cell)];
    const AxisWeights w = axis_weights(axis, x, h, setup_.beyond[d], cell);
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
void UnresolvedCoupling::take_whole_runs(Place& p, Real* along) const {
  const int whole = (p.count[0] + kRun - 1) / kRun * kRun, nx = grid_.nx();
  p.in_pieces = p.first[0] < 0 || p.first[0] + p.count[0] > nx || whole > nx;
  if (p.in_pieces) return;
  const int back = std::max(p.first[0] + whole - nx, 0);
  std::rotate(along, along + whole - back, along + whole);
  p.first[0] -= back;
  p.count[0] = whole;
}

/// Near bodies the fluid around them takes what would lie inside. Bodies do not cross periodic sides.
void UnresolvedCoupling::place_near_bodies(std::size_t at) {
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

template <class Visit>
void UnresolvedCoupling::for_each_in_plane(int k, const Visit& visit) const {
  const int nz = grid_.nz(), ny = grid_.ny();
  const bool all = 2 * reach_ + 1 >= nz, around = setup_.beyond[2][0] == Beyond::periodic;
  for (int near = all ? 0 : k - reach_; near < (all ? nz : k + reach_ + 1); ++near) {
    if (!around && (near < 0 || near >= nz)) continue;
    const std::size_t row = static_cast<std::size_t>(wrapped(near, 2) * ny);
    const std::size_t end = static_cast<std::size_t>(first_of_row_[row + static_cast<std::size_t>(ny)]);
    for (std::size_t at = static_cast<std::size_t>(first_of_row_[row]); at < end; ++at) {
      const int plane = k - places_[at].first[2];
      for (int c = plane < 0     ? plane + nz
                   : plane >= nz ? plane - nz
                                 : plane;
           c < places_[at].count[2]; c += nz)
        visit(at, c);
    }
  }
}

/// Plane by plane in double, each plane's grains in the order of the list.
template <std::size_t kN, class Values>
void UnresolvedCoupling::scatter(const std::array<FieldView, kN>& to, const Values& values) const {
  const std::size_t nx = static_cast<std::size_t>(grid_.nx()),
                    cells = nx * static_cast<std::size_t>(grid_.ny());
  for_each_index_dynamic(grid_.nz(), [&](int k) {
    thread_local std::vector<double> sums;
    sums.assign(kN * cells, 0.0);
    const ConstFieldView room = room_.view();
    for_each_in_plane(k, [&](std::size_t at, int plane) {
      const Place& p = places_[at];
      const Real* along = weights(at, 0);
      const std::array<double, kN> value = values(at);
      for_each_row(at, plane, [&](int j, int, Real w) {
        double* row = sums.data() + static_cast<std::size_t>(j) * nx;
        if (p.in_pieces) {
          for (int a = 0; a < p.count[0]; ++a) {
            const int i = wrapped(p.first[0] + a, 0);
            const double weight = w * along[a] * (p.near_bodies ? room(i, j, k) : Real(1));
            for (std::size_t c = 0; c < kN; ++c)
              row[c * cells + static_cast<std::size_t>(i)] += weight * value[c];
          }
          return;
        }
        for (int a = 0; a < p.count[0]; a += kRun) {
          RealRun weight = w * run_at(along + a);
          if (p.near_bodies) weight *= run_at(room.row(j, k) + p.first[0] + a);
          const DoubleRun wide = __builtin_convertvector(weight, DoubleRun);
          for (std::size_t c = 0; c < kN; ++c)
            *reinterpret_cast<DoubleRun*>(row + c * cells + p.first[0] + a) += wide * value[c];
        }
      });
    });
    for (int j = 0; j < grid_.ny(); ++j) {
      const double area =
          inverse_widths_[1][static_cast<std::size_t>(j)] * inverse_widths_[2][static_cast<std::size_t>(k)];
      const double *width = inverse_widths_[0].data(), *row = sums.data() + static_cast<std::size_t>(j) * nx;
      for (std::size_t c = 0; c < kN; ++c)
        for_each_in_lanes(0, grid_.nx(), [=, out = to[c].row(j, k), from = row + c * cells](int i) {
          out[i] = static_cast<Real>(area * width[i] * from[i]);
        });
      for (std::size_t c = 0; bodies_ && c < kN; ++c)
        for_each_in_lanes(0, grid_.nx(), [out = to[c].row(j, k), part = room.row(j, k)](int i) {
          out[i] = part[i] > 0 ? out[i] / part[i] : Real(0);
        });
    }
  });
}

void UnresolvedCoupling::map(std::span<const Body> grains, const std::vector<char>& here,
                             const std::array<ConstFieldView, 3>& velocity, ConstFieldView density,
                             const CutCells& cut, double dt, FluidFraction& f) {
  note_grains(grains);
  note_room(cut);
  sort_grains(grains, here);
  place_grains(grains);
  std::swap(f.solids_before, f.solids);
  scatter<1>({f.solids.view()}, [&](std::size_t at) {
    return std::array{volumes_[static_cast<std::size_t>(places_[at].grain)]};
  });
  if (!mapped_) f.solids_before = f.solids;  // they are there from the beginning
  mapped_ = true;
  dt_ = dt;
  find_drags(grains, {velocity[0], velocity[1], velocity[2], f.solids.view(), density}, dt);
  const double inverse = 1 / setup_.fluid_density;
  scatter<4>({f.drag.view(), f.dragging[0].view(), f.dragging[1].view(), f.dragging[2].view()},
             [&](std::size_t at) {
               const double c = inverse * drags_[at].coefficient;
               const Vec3& v = drags_[at].carried;
               return std::array{c, c * v.x(), c * v.y(), c * v.z()};
             });
}

void UnresolvedCoupling::find_drags(std::span<const Body> grains, const std::array<ConstFieldView, 5>& fields,
                                    double dt) {
  constexpr std::size_t kSize = drag::Batch::kSize;
  static_assert(kGrainBlock % kSize == 0);
  const bool wakes = setup_.acts && grid_.active(0) && grid_.active(1) && grid_.active(2);
  const drag::Step step{setup_.fluid_density, setup_.viscosity, dt, wakes ? 1.0 : 0.0};
  drags_.resize(places_.size());
  std::vector<GrainExtremes> met(block_count_of(places_.size()));
  for_each_grain_block(places_.size(), [&](std::size_t b, std::size_t begin, std::size_t end) {
    for (; begin < end; begin += kSize) {
      drag::Batch batch;
      for (std::size_t n = 0; n < kSize; ++n)  // the last batch is filled with its last grain
        look_around(grains, std::min(begin + n, end - 1), fields, batch, n);
      if (setup_.drag) setup_.drag(step, batch);
      for (std::size_t n = 0; n < std::min(kSize, end - begin); ++n) {
        const Place& p = places_[begin + n];
        drags_[begin + n] = {};
        if (!(p.inside > 0)) continue;
        met[b].fraction = std::min(met[b].fraction, batch.fraction[n]);
        if (!setup_.drag) continue;
        met[b].reynolds = std::max(met[b].reynolds, batch.reynolds[n]);
        drags_[begin + n] = {batch.coefficient[n],
                             grains[static_cast<std::size_t>(p.grain)].velocity +
                                 Vec3(batch.gain[0][n], batch.gain[1][n], batch.gain[2][n])};
      }
    }
  });
  extremes_ = {};
  for (const GrainExtremes& m : met)
    extremes_ = {std::max(extremes_.reynolds, m.reynolds), std::min(extremes_.fraction, m.fraction)};
}

/// What the drag on the grain of a place depends on, as number n of a batch.
void UnresolvedCoupling::look_around(std::span<const Body> grains, std::size_t at,
                                     const std::array<ConstFieldView, 5>& fields, drag::Batch& batch,
                                     std::size_t n) const {
  constexpr double kLeastFraction = 0.05;
  const Place& p = places_[at];
  const std::size_t g = static_cast<std::size_t>(p.grain);
  const Body &grain = grains[g],
             &later = grains[static_cast<std::size_t>(listed_[std::min(at + kAhead, listed_.size() - 1)])];
  __builtin_prefetch(&later.velocity);
  __builtin_prefetch(&later.motion);
  const auto seen = gather<4>(at, {fields[0], fields[1], fields[2], fields[3]});
  const double inverse = p.inside > 0 ? 1 / p.inside : 0.0;
  batch.fluid_density[n] =
      fields[4].origin && p.inside > 0 ? inverse * gather<1>(at, {fields[4]})[0] : setup_.fluid_density;
  batch.diameter[n] = diameters_[g];
  batch.volume[n] = volumes_[g];
  batch.mass[n] = masses_[g];
  batch.is_free[n] = grain.motion == Motion::free;
  batch.fraction[n] = std::max(1 - inverse * seen[3], kLeastFraction);
  batch.density[n] = p.density;
  batch.spread[n] = p.spread;
  for (int c = 0; c < 3; ++c) {
    const std::size_t d = static_cast<std::size_t>(c);
    batch.slip[d][n] = inverse * seen[d] - grain.velocity[c];
    batch.acceleration[d][n] = setup_.gravity[c] + pushed_[g][c];
  }
}

void UnresolvedCoupling::collect(std::span<const Body> grains, const std::vector<char>& here,
                                 FluidFraction& f, std::span<Load> loads) {
  drag_force_.resize(grains.size());
  for_each_grain_block(grains.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      if (here[n]) continue;
      loads[n] = Load{};
      drag_force_[n].setZero();
      pushed_[n].setZero();
    }
  });
  const std::array<ConstFieldView, 6> fields{f.seen[0].view(), f.seen[1].view(), f.seen[2].view(),
                                             f.push[0].view(), f.push[1].view(), f.push[2].view()};
  const Vec3 driven = setup_.body_force - setup_.gravity;
  for_each_grain_block(places_.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t at = begin; at < end; ++at) {
      const std::size_t n = static_cast<std::size_t>(listed_[at]),
                        later = static_cast<std::size_t>(listed_[std::min(at + kAhead, end - 1)]);
      __builtin_prefetch(&loads[later], 1);
      __builtin_prefetch(&drag_force_[later], 1);
      __builtin_prefetch(&pushed_[later], 1);
      const auto sums = gather<6>(at, fields);
      const Vec3 u(sums[0], sums[1], sums[2]), gradients(sums[3], sums[4], sums[5]);
      const double inside = places_[at].inside;
      drag_force_[n] = drags_[at].coefficient * (u - inside * drags_[at].carried);
      const Vec3 by_volume = setup_.fluid_density * volumes_[n] * (gradients + inside * driven);
      loads[n] = Load{};
      loads[n].force = drag_force_[n] + by_volume;
      pushed_[n] = by_volume / masses_[n];
    }
  });
  if (setup_.works) find_work(grains, f);
}

/// Drag times the mean of the velocities with which a grain begins and ends the step if it meets nothing.
void UnresolvedCoupling::find_work(std::span<const Body> grains, FluidFraction& f) const {
  scatter<1>({f.work.view()}, [&](std::size_t at) {
    const std::size_t n = static_cast<std::size_t>(places_[at].grain);
    const Vec3& drag = drag_force_[n];
    const Vec3 gain = grains[n].motion == Motion::free
                          ? Vec3(dt_ * (drag / masses_[n] + pushed_[n] + setup_.gravity))
                          : Vec3(0, 0, 0);
    const double inside = places_[at].inside;
    return std::array{inside > 0 ? dt_ / inside * drag.dot(grains[n].velocity + 0.5 * gain) : 0.0};
  });
}

double UnresolvedCoupling::mapped_volume(const FluidFraction& f) const {
  return reduce_sum(grid_.range(), [&](int i, int j, int k) {
    return double(f.solids(i, j, k)) * grid_.volume(i, j, k) * (bodies_ ? double(room_(i, j, k)) : 1.0);
  });
}

std::vector<double> UnresolvedCoupling::state() const {
  std::vector<double> out{mapped_ ? 1.0 : 0.0};
  for (const Vec3& v : pushed_) out.insert(out.end(), v.data(), v.data() + 3);
  return out;
}

void UnresolvedCoupling::restore(std::span<const double> state, std::size_t grains) {
  StateReader in(state, "grains");
  mapped_ = in.whole(0, 1) == 1;
  pushed_.assign(mapped_ ? grains : 0, Vec3(0, 0, 0));
  for (Vec3& v : pushed_) v = in.vec3();
  in.end();
}

}  // namespace ejecta
