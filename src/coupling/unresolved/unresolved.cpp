#include "coupling/unresolved/unresolved.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.hpp"
#include "base/state_reader.hpp"
#include "coupling/unresolved/own_wake.hpp"

namespace ejecta {
namespace {

/// (1 - exp(-x)) / x
double relaxed(double x) { return x > 1e-8 ? -std::expm1(-x) / x : 1 - 0.5 * x; }

/// 1/(1 - exp(-x)) - 1/x: what of dt times a steady acceleration counts in the velocity that the drag over
/// dt acts on, x relaxation times long: half without drag, all with much.
double lag(double x) { return x > 1e-3 ? -1 / std::expm1(-x) - 1 / x : 0.5 + x / 12; }

}  // namespace

UnresolvedCoupling::UnresolvedCoupling(const Grid& grid, const UnresolvedSetup& setup)
    : grid_(grid), setup_(setup) {
  for (int d = 0; d < 3; ++d)
    for (const double w : grid.axis(d).width) inverse_widths_[static_cast<std::size_t>(d)].push_back(1 / w);
}

/// visit(i, count, j, k, weight, weights along x) for runs of cells in plane number `plane` of a grain's own.
template <class Visit>
void UnresolvedCoupling::for_each_run(const Place& p, int plane, const Visit& visit) const {
  const int k = wrapped(p.axis[2].first + plane, 2), nx = grid_.nx();
  const double wz = p.scale * p.axis[2].weight[static_cast<std::size_t>(plane)];
  const int first = p.axis[0].first, count = p.axis[0].count;
  for (int b = 0; b < p.axis[1].count; ++b) {
    const int j = wrapped(p.axis[1].first + b, 1);
    const double w = wz * p.axis[1].weight[static_cast<std::size_t>(b)];
    const double* along = p.axis[0].weight.data();
    const int before = std::clamp(-first, 0, count), after = std::clamp(first + count - nx, 0, count);
    if (before > 0) visit(first + nx, before, j, k, w, along);
    if (const int within = count - before - after; within > 0)
      visit(first + before, within, j, k, w, along + before);
    if (after > 0) visit(0, after, j, k, w, along + count - after);
  }
}

/// Sums of weight * field over the cells of a grain, and that of the weights.
template <std::size_t kN>
std::array<double, kN + 1> UnresolvedCoupling::gather(const Place& p,
                                                      const std::array<ConstFieldView, kN>& fields) const {
  std::array<double, kN + 1> sums{};
  for (int plane = 0; plane < p.axis[2].count; ++plane)
    for_each_run(p, plane, [&](int i, int n, int j, int k, double w, const double* along) {
      Real weight[AxisWeights::kMost];
      for (int a = 0; a < n; ++a) weight[a] = static_cast<Real>(along[a]);
      if (p.near_bodies) {
        const Real* room = room_.view().row(j, k) + i;
        for (int a = 0; a < n; ++a) weight[a] *= room[a];
      }
      Real part[kN + 1] = {};
      const Real* rows[kN + 1];
      for (std::size_t c = 0; c < kN; ++c) rows[c] = fields[c].row(j, k) + i;
      for (int a = 0; a < n; ++a) {
        for (std::size_t c = 0; c < kN; ++c) part[c] += weight[a] * rows[c][a];
        part[kN] += weight[a];
      }
      for (std::size_t c = 0; c <= kN; ++c) sums[c] += w * double(part[c]);
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

/// Near bodies the fluid around them takes what would lie inside.
void UnresolvedCoupling::place(const Body& grain, double diameter, Place& out) const {
  const double width = setup_.kernel_width * diameter;
  double inside = 1, spread = 0;
  out.density = 1;
  for (int d = 0; d < 3; ++d) {
    const Axis& axis = grid_.axis(d);
    const double h = kernel_half_width(axis, grain.position[d], width),
                 cell = axis.width[static_cast<std::size_t>(axis.cell_at(grain.position[d]))];
    out.axis[d] = axis_weights(axis, grain.position[d], h, setup_.beyond[static_cast<std::size_t>(d)]);
    spread += (h * h / 7 + cell * cell / 12) / 3;  // variance of the kernel and of a cell
    double sum = 0, squares = 0;
    for (int n = 0; n < out.axis[d].count; ++n) {
      const double w = out.axis[d].weight[static_cast<std::size_t>(n)];
      sum += w;
      squares += w * w *
                 inverse_widths_[static_cast<std::size_t>(d)]
                                [static_cast<std::size_t>(wrapped(out.axis[d].first + n, d))];
    }
    inside *= sum;
    out.density *= squares;
  }
  out.scale = inside > 0 ? 1 : 0;
  out.spread = std::sqrt(spread);
  out.near_bodies = false;
  if (!bodies_ || !(inside > 0)) return;
  // Bodies do not cross periodic sides.
  const int low[3] = {around_.i0, around_.j0, around_.k0}, high[3] = {around_.i1, around_.j1, around_.k1};
  for (int d = 0; d < 3; ++d)
    if (out.axis[d].first >= high[d] || out.axis[d].first + out.axis[d].count <= low[d]) return;
  out.near_bodies = true;
  const double open = gather<0>(out, {})[0];
  out.scale = open > 1e-9 * inside && open > 0 ? inside / open : 0;
}

/// Counting sort by plane: the grains of a plane stand in their order.
void UnresolvedCoupling::list_planes() {
  const std::size_t planes = static_cast<std::size_t>(grid_.nz());
  first_.assign(planes + 1, 0);
  const auto each = [&](const auto& visit) {
    for (std::size_t n = 0; n < places_.size(); ++n)
      if (places_[n].scale > 0)
        for (int c = 0; c < places_[n].axis[2].count; ++c)
          visit(static_cast<std::size_t>(wrapped(places_[n].axis[2].first + c, 2)), n, c);
  };
  each([&](std::size_t k, std::size_t, int) { ++first_[k + 1]; });
  for (std::size_t k = 0; k < planes; ++k) first_[k + 1] += first_[k];
  listed_.resize(static_cast<std::size_t>(first_.back()));
  std::vector<int> next(first_.begin(), first_.end() - 1);
  each([&](std::size_t k, std::size_t n, int plane) {
    listed_[static_cast<std::size_t>(next[k]++)] = static_cast<int>(n) * AxisWeights::kMost + plane;
  });
}

/// Plane by plane in double, each plane's grains in their order.
template <std::size_t kN, class Values>
void UnresolvedCoupling::scatter(const std::array<FieldView, kN>& to, const Values& values) const {
  const int nx = grid_.nx(), ny = grid_.ny();
  const std::size_t cells = static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny);
  for_each_index_dynamic(grid_.nz(), [&](int k) {
    thread_local std::vector<double> sums;
    sums.assign(kN * cells, 0.0);
    const ConstFieldView room = room_.view();
    const std::size_t p = static_cast<std::size_t>(k);
    for (int e = first_[p]; e < first_[p + 1]; ++e) {
      const int entry = listed_[static_cast<std::size_t>(e)];
      const std::size_t n = static_cast<std::size_t>(entry / AxisWeights::kMost);
      const std::array<double, kN> value = values(n);
      const Place& place = places_[n];
      for_each_run(place, entry % AxisWeights::kMost,
                   [&](int i, int run, int j, int, double w, const double* along) {
                     double weight[AxisWeights::kMost];
                     for (int a = 0; a < run; ++a)
                       weight[a] = place.near_bodies ? along[a] * double(room(i + a, j, k)) : along[a];
                     double* row = &sums[static_cast<std::size_t>(j) * static_cast<std::size_t>(nx) +
                                         static_cast<std::size_t>(i)];
                     for (std::size_t c = 0; c < kN; ++c) {
                       double* to = row + c * cells;
                       const double v = w * value[c];
                       for (int a = 0; a < run; ++a) to[a] += v * weight[a];
                     }
                   });
    }
    std::vector<double> inverse_area;
    for (const double y : inverse_widths_[1]) inverse_area.push_back(y * inverse_widths_[2][p]);
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        double inverse =
            inverse_widths_[0][static_cast<std::size_t>(i)] * inverse_area[static_cast<std::size_t>(j)];
        if (bodies_) inverse = room_(i, j, k) > 0 ? inverse / double(room_(i, j, k)) : 0;
        const double* cell =
            &sums[static_cast<std::size_t>(j) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(i)];
        for (std::size_t c = 0; c < kN; ++c) to[c](i, j, k) = static_cast<Real>(inverse * cell[c * cells]);
      }
  });
}

void UnresolvedCoupling::map(std::span<const Body> grains, const std::vector<char>& here,
                             const std::array<ConstFieldView, 3>& velocity, const CutCells& cut, double dt,
                             FluidFraction& f) {
  const int count = static_cast<int>(grains.size());
  places_.resize(grains.size());
  drags_.resize(grains.size());
  for (std::size_t n = diameters_.size(); n < grains.size(); ++n) {
    diameters_.push_back(2 * grains[n].shape.bounding_radius());
    volumes_.push_back(grains[n].shape.mass_properties().volume);
  }
  pushed_.resize(grains.size(), Vec3(0, 0, 0));
  note_room(cut);
  for_each_index(count, [&](int g) {
    const std::size_t n = static_cast<std::size_t>(g);
    if (here[n]) place(grains[n], diameters_[n], places_[n]);
    else places_[n].scale = 0;
  });
  list_planes();
  std::swap(f.solids_before, f.solids);
  scatter<1>({f.solids.view()}, [&](std::size_t n) { return std::array{volumes_[n]}; });
  if (!mapped_) f.solids_before = f.solids;  // they are there from the beginning
  mapped_ = true;
  for_each_index(count, [&](int g) {
    find_drag(grains[static_cast<std::size_t>(g)], static_cast<std::size_t>(g), velocity, f.solids.view(),
              dt);
  });
  const double inverse = 1 / setup_.fluid_density;
  scatter<4>({f.drag.view(), f.dragging[0].view(), f.dragging[1].view(), f.dragging[2].view()},
             [&](std::size_t n) {
               const double c = inverse * drags_[n].coefficient;
               const Vec3& v = drags_[n].carried;
               return std::array{c, c * v.x(), c * v.y(), c * v.z()};
             });
}

/// m dv/dt = m a + beta (u - v) over dt with beta held: its mean drag is
/// (m/dt) (1 - exp(-x)) (u - v - lag(x) dt a), x = beta dt / m.
void UnresolvedCoupling::find_drag(const Body& grain, std::size_t n,
                                   const std::array<ConstFieldView, 3>& velocity, ConstFieldView solids,
                                   double dt) {
  GrainDrag& out = drags_[n];
  out = {};
  if (!(places_[n].scale > 0)) return;
  const auto seen = gather<4>(places_[n], {velocity[0], velocity[1], velocity[2], solids});
  Vec3 u(seen[0], seen[1], seen[2]);
  const double packed = seen[3], inside = seen[4];
  if (!(inside > 0)) return;
  u /= inside;
  out.inside = inside;
  out.fraction = std::max(1 - packed / inside, 0.05);
  if (!setup_.drag) return;
  drag::Surroundings s{diameters_[n], 0, out.fraction, setup_.fluid_density, setup_.viscosity};
  // The coefficient of a slip as it is seen: the true one is larger by what the grain itself moves.
  const bool wakes = setup_.acts && grid_.active(0) && grid_.active(1) && grid_.active(2);
  const auto coefficient = [&](double seen) {
    s.slip = seen;
    double beta = setup_.drag(s);
    for (int again = 0; wakes && again < 2; ++again) {
      const double sigma = places_[n].spread;
      // Among many a drag law means the mean flow, which all of them make, this one too.
      const double own = volumes_[n] * places_[n].density, others = std::max(1 - out.fraction - own, 0.0);
      const double wake =
          own / (own + others) *
          own_wake(sigma, s.slip, s.density, s.viscosity, others * beta / (s.density * volumes_[n]));
      const double larger = 1 / (1 - std::min(beta * wake, kMostWake));
      s.slip = seen * larger;
      beta = setup_.drag(s);
      if (again == 1) beta *= larger;
    }
    return beta;
  };
  const Vec3 slip = u - grain.velocity;
  double beta = coefficient(slip.norm());
  out.reynolds = s.reynolds();
  if (grain.motion != Motion::free) {
    out.coefficient = beta;
    out.carried = grain.velocity;
    return;
  }
  const Vec3 a = setup_.gravity + pushed_[n];
  // Once more with the mean slip of the step, where that differs.
  constexpr double kShort = 0.01;
  if (dt * beta > kShort * grain.mass) {
    const Vec3 rest = -grain.mass / beta * a;
    beta = coefficient((rest + relaxed(dt * beta / grain.mass) * (slip - rest)).norm());
  }
  const double x = dt * beta / grain.mass;
  out.coefficient = beta * relaxed(x);
  out.carried = grain.velocity + lag(x) * dt * a;
}

void UnresolvedCoupling::collect(std::span<const Body> grains, const std::vector<char>& here,
                                 const FluidFraction& f, std::span<Load> loads) {
  drag_force_.assign(grains.size(), Vec3(0, 0, 0));
  const std::array<ConstFieldView, 3> seen{f.seen[0].view(), f.seen[1].view(), f.seen[2].view()},
      push{f.push[0].view(), f.push[1].view(), f.push[2].view()};
  for_each_index(static_cast<int>(grains.size()), [&](int g) {
    const std::size_t n = static_cast<std::size_t>(g);
    loads[n] = Load{};
    pushed_[n].setZero();
    if (!here[n] || !(places_[n].scale > 0)) return;
    const auto sums = gather<6>(places_[n], {seen[0], seen[1], seen[2], push[0], push[1], push[2]});
    const Vec3 u(sums[0], sums[1], sums[2]), gradients(sums[3], sums[4], sums[5]);
    const double inside = sums[6];
    const GrainDrag& drag = drags_[n];
    drag_force_[n] = drag.coefficient * (u - inside * drag.carried);
    const double displaced = setup_.fluid_density * volumes_[n];
    const Vec3 by_volume = displaced * (gradients + inside * Vec3(setup_.body_force - setup_.gravity));
    loads[n].force = drag_force_[n] + by_volume;
    pushed_[n] = by_volume / grains[n].mass;
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
