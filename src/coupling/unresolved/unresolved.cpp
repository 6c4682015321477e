#include "coupling/unresolved/unresolved.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.hpp"
#include "base/state_reader.hpp"

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

template <class Visit>
void UnresolvedCoupling::for_each_in_plane(const Place& p, int plane, const Visit& visit) const {
  const int k = wrapped(p.axis[2].first + plane, 2);
  const double wz = p.scale * p.axis[2].weight[static_cast<std::size_t>(plane)];
  for (int b = 0; b < p.axis[1].count; ++b) {
    const int j = wrapped(p.axis[1].first + b, 1);
    const double wyz = wz * p.axis[1].weight[static_cast<std::size_t>(b)];
    for (int a = 0; a < p.axis[0].count; ++a) {
      const int i = wrapped(p.axis[0].first + a, 0);
      const double w = wyz * p.axis[0].weight[static_cast<std::size_t>(a)];
      visit(i, j, k, bodies_ ? w * double(room_(i, j, k)) : w);
    }
  }
}

template <class Visit>
void UnresolvedCoupling::for_each_of(const Place& p, const Visit& visit) const {
  for (int plane = 0; plane < p.axis[2].count; ++plane) for_each_in_plane(p, plane, visit);
}

/// Cells whose fluid is carried by another have no velocity of their own, nor have cells in bodies.
void UnresolvedCoupling::note_room(const CutCells& cut) {
  bodies_ = !cut.empty();
  if (!bodies_) return;
  if (room_.size() == 0) room_ = grid_.make_field();
  room_.fill(1);
  for (const GhostCell& g : cut.ghosts) room_(g.i, g.j, g.k) = 0;
  for (std::size_t n = 0; n < cut.cells.size(); ++n) {
    const CutCell& c = cut.cells[n];
    room_(c.i, c.j, c.k) = c.locked || c.carrier != static_cast<int>(n) ? Real(0) : c.carried;
  }
}

/// Near bodies the fluid around them takes what would lie inside.
void UnresolvedCoupling::place(const Body& grain, double diameter, Place& out) const {
  const double width = setup_.kernel_width * diameter;
  double inside = 1;
  for (int d = 0; d < 3; ++d) {
    const Axis& axis = grid_.axis(d);
    out.axis[d] = axis_weights(axis, grain.position[d], kernel_half_width(axis, grain.position[d], width),
                               setup_.beyond[static_cast<std::size_t>(d)]);
    double sum = 0;
    for (int n = 0; n < out.axis[d].count; ++n) sum += out.axis[d].weight[static_cast<std::size_t>(n)];
    inside *= sum;
  }
  out.scale = 1;
  if (!bodies_) return;
  double open = 0;
  for_each_of(out, [&](int, int, int, double w) { open += w; });
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
    const std::size_t p = static_cast<std::size_t>(k);
    for (int e = first_[p]; e < first_[p + 1]; ++e) {
      const int entry = listed_[static_cast<std::size_t>(e)];
      const std::size_t n = static_cast<std::size_t>(entry / AxisWeights::kMost);
      const std::array<double, kN> value = values(n);
      for_each_in_plane(places_[n], entry % AxisWeights::kMost, [&](int i, int j, int, double w) {
        double* cell = &sums[kN * (static_cast<std::size_t>(j) * static_cast<std::size_t>(nx) +
                                   static_cast<std::size_t>(i))];
        for (std::size_t c = 0; c < kN; ++c) cell[c] += w * value[c];
      });
    }
    std::vector<double> inverse_area;
    for (const double y : inverse_widths_[1]) inverse_area.push_back(y * inverse_widths_[2][p]);
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        double inverse = inverse_widths_[0][static_cast<std::size_t>(i)] * inverse_area[static_cast<std::size_t>(j)];
        if (bodies_) inverse = room_(i, j, k) > 0 ? inverse / double(room_(i, j, k)) : 0;
        const double* cell = &sums[kN * (static_cast<std::size_t>(j) * static_cast<std::size_t>(nx) +
                                         static_cast<std::size_t>(i))];
        for (std::size_t c = 0; c < kN; ++c) to[c](i, j, k) = static_cast<Real>(inverse * cell[c]);
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
  scatter<1>({f.solids.view()},
             [&](std::size_t n) { return std::array{volumes_[n]}; });
  if (!mapped_) f.solids_before = f.solids;  // they are there from the beginning
  mapped_ = true;
  for_each_index(count, [&](int g) {
    find_drag(grains[static_cast<std::size_t>(g)], static_cast<std::size_t>(g), velocity, f.solids.view(), dt);
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
  Vec3 u(0, 0, 0);
  double packed = 0, inside = 0;
  for_each_of(places_[n], [&](int i, int j, int k, double w) {
    u += w * Vec3(velocity[0](i, j, k), velocity[1](i, j, k), velocity[2](i, j, k));
    packed += w * double(solids(i, j, k));
    inside += w;
  });
  if (!(inside > 0)) return;
  u /= inside;
  out.inside = inside;
  out.fraction = std::max(1 - packed / inside, 0.05);
  if (!setup_.drag) return;
  const bool held = grain.motion != Motion::free;
  drag::Surroundings s{diameters_[n], (u - grain.velocity).norm(), out.fraction, setup_.fluid_density,
                       setup_.viscosity};
  out.reynolds = s.reynolds();
  double beta = setup_.drag(s);
  if (held) {
    out.coefficient = beta;
    out.carried = grain.velocity;
    return;
  }
  const Vec3 a = setup_.gravity + pushed_[n];
  // Once more with the mean slip of the step, where that differs.
  constexpr double kShort = 0.01;
  const Vec3 slip = u - grain.velocity, rest = -grain.mass / beta * a;
  if (dt * beta > kShort * grain.mass) {
  s.slip = (rest + relaxed(dt * beta / grain.mass) * (slip - rest)).norm();
  beta = setup_.drag(s);
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
    Vec3 u(0, 0, 0), gradients(0, 0, 0);
    double inside = 0;
    for_each_of(places_[n], [&](int i, int j, int k, double w) {
      inside += w;
      for (std::size_t c = 0; c < 3; ++c) {
        const int d = static_cast<int>(c);
        u[d] += w * double(seen[c](i, j, k));
        gradients[d] += w * double(push[c](i, j, k));
      }
    });
    const GrainDrag& drag = drags_[n];
    drag_force_[n] = drag.coefficient * (u - inside * drag.carried);
    const double displaced = setup_.fluid_density * volumes_[n];
    const Vec3 by_volume =
        displaced * (gradients + inside * Vec3(setup_.body_force - setup_.gravity));
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
