#include "flow/boundary.hpp"

#include <algorithm>

#include "flow/stencil.hpp"

namespace ejecta {
namespace {

/// The two directions across d, in the order of storage.
int first_across(int d) { return d == 0 ? 1 : 0; }
int second_across(int d) { return d == 2 ? 1 : 2; }

/// Cell indices on a face normal to d, from in-plane indices and the index along d.
struct Index {
  int i, j, k;
};

Index index_on(int d, int a, int b, int along) {
  if (d == 0) return {along, a, b};
  if (d == 1) return {a, along, b};
  return {a, b, along};
}

}  // namespace

void Boundaries::Plane::resize() {
  const std::size_t size = static_cast<std::size_t>(na) * static_cast<std::size_t>(nb);
  for (auto* v : {&velocity[0], &velocity[1], &velocity[2], &k, &dissipation, &pressure}) v->resize(size);
  prescribed.resize(size);
}

void Boundaries::Plane::set(int a, int b, const BoundaryState& state) {
  const std::size_t n = index(a, b);
  for (std::size_t c = 0; c < 3; ++c) velocity[c][n] = state.velocity[c];
  k[n] = state.k;
  dissipation[n] = state.dissipation;
  pressure[n] = state.pressure;
  prescribed[n] = state.prescribed;
}

Boundaries::Boundaries(const Grid& grid, std::array<Boundary, 6> faces)
    : grid_(grid), faces_(std::move(faces)) {
  for (int face = 0; face < 6; ++face) {
    const int d = face / 2;
    Plane& p = planes_[static_cast<std::size_t>(face)];
    p.na = grid.n(first_across(d));
    p.nb = grid.n(second_across(d));
    p.resize();
  }
}

std::array<int, 3> Boundaries::on_face(int face, int a, int b) const {
  const int d = face / 2;
  const Index f = index_on(d, a, b, face % 2 ? grid_.n(d) : 0);
  return {f.i, f.j, f.k};
}

bool Boundaries::prescribed_on(int d, const std::array<int, 3>& face) const {
  const int at = face[static_cast<std::size_t>(d)];
  if (at != 0 && at != grid_.n(d)) return false;
  return prescribed(2 * d + (at != 0), face[static_cast<std::size_t>(first_across(d))],
                    face[static_cast<std::size_t>(second_across(d))]);
}

bool Boundaries::discs() const {
  return std::any_of(faces_.begin(), faces_.end(), [](const Boundary& b) { return b.discs; });
}

bool Boundaries::open() const {
  for (int face = 0; face < 6; ++face)
    if (grid_.active(face / 2) && kind(face) == BoundaryKind::open) return true;
  return false;
}

void Boundaries::update(double time) {
  for (int face = 0; face < 6; ++face) {
    const Boundary& boundary = faces_[static_cast<std::size_t>(face)];
    Plane& p = planes_[static_cast<std::size_t>(face)];
    if (!boundary.state || (p.fresh && !boundary.varies)) continue;
    const int d = face / 2, da = first_across(d), db = second_across(d);
    const Axis& axis = grid_.axis(d);
    for_each_index(p.nb, [&](int b) {
      for (int a = 0; a < p.na; ++a) {
        Vec3 x;
        x[d] = face % 2 ? axis.face.back() : axis.face.front();
        x[da] = grid_.axis(da).centre[static_cast<std::size_t>(a)];
        x[db] = grid_.axis(db).centre[static_cast<std::size_t>(b)];
        p.set(a, b, boundary.state(x, time));
      }
    });
    p.fresh = true;
  }
}

Boundaries::Side Boundaries::side(const FieldView& f, int face) const {
  Side s{};
  s.d = face / 2;
  s.upper = face % 2;
  const int da = first_across(s.d), db = second_across(s.d);
  const std::ptrdiff_t step = stride(f, s.d);
  s.na = grid_.n(da);
  s.nb = grid_.n(db);
  // Directions are filled in order, each with the ghosts already set, so that edges are filled too.
  s.ghosts_a = da < s.d && grid_.active(da) ? kGhosts : 0;
  s.ghosts_b = db < s.d && grid_.active(db) ? kGhosts : 0;
  s.first = s.upper ? (grid_.n(s.d) - 1) * step : 0;
  s.step_a = stride(f, da);
  s.step_b = stride(f, db);
  s.outward = s.upper ? step : -step;
  s.face = s.upper ? step : 0;
  return s;
}

/// ghost(field, layer, a, b, cell, inner) -> value of a ghost; `field` an integral_constant, a and b clamped
/// to the face, `cell` the offset of the boundary cell, `inner` the value as far inside as the ghost is
/// outside (periodic: on the other side). Ghosts of a row are computed in any order.
template <std::size_t kN, class Ghost>
void Boundaries::fill_side(const std::array<FieldView, kN>& fields, const Side& s, bool periodic,
                           const Ghost& ghost) const {
  const int n = grid_.n(s.d);
  const auto fill_row = [&](auto field, int layer, int b, std::ptrdiff_t start) {
    Real* origin = fields[field].origin + start;
    const std::ptrdiff_t out = (layer + 1) * s.outward, in = -(periodic ? n - 1 - layer : layer) * s.outward;
    const auto set = [ =, &ghost ](int a, std::ptrdiff_t cell) __attribute__((always_inline)) {
      origin[cell + out] = ghost(field, layer, a, b, start + cell, origin[cell + in]);
    };
    for (int a = -s.ghosts_a; a < 0; ++a) set(0, a * s.step_a);
    if (s.step_a == 1) {
      for_each_in_lanes(
          0, s.na, [&](int a) __attribute__((always_inline)) { set(a, a); });
    } else {
      for (int a = 0; a < s.na; ++a) set(a, a * s.step_a);
    }
    for (int a = s.na; a < s.na + s.ghosts_a; ++a) set(s.na - 1, a * s.step_a);
  };
  for_each_index(s.nb + 2 * s.ghosts_b, [&](int row) {
    const int b = std::clamp(row - s.ghosts_b, 0, s.nb - 1);
    const std::ptrdiff_t start = s.cell(0, row - s.ghosts_b);
    const auto fill_fields = [&]<std::size_t... field>(std::index_sequence<field...>, int layer) {
      (fill_row(std::integral_constant<std::size_t, field>{}, layer, b, start), ...);
    };
    for (int layer = 0; layer < kGhosts; ++layer) fill_fields(std::make_index_sequence<kN>{}, layer);
  });
}

namespace {

/// go(std::true_type) or go(std::false_type): what holds for a whole face is decided outside its loops.
template <class Go>
void decide(bool yes, const Go& go) {
  if (yes) go(std::true_type{});
  else go(std::false_type{});
}

/// A copy of the value inside.
constexpr auto kCopy = [](auto, int, int, int, std::ptrdiff_t, Real inner) { return inner; };

/// What leaves the box through face cell (a, b), m/s.
auto out_through(const std::array<FieldView, 3>& q, const auto& s) {
  return [
    face = q[static_cast<std::size_t>(s.d)].origin + s.face + s.first, step_a = s.step_a, step_b = s.step_b,
    sign = s.upper ? Real(1) : Real(-1)
  ](int a, int b) __attribute__((always_inline)) {
    return sign * face[a * step_a + b * step_b];
  };
}

}  // namespace

void Boundaries::fill_zero_gradient(FieldView f) const {
  for (int face = 0; face < 6; ++face)
    if (grid_.active(face / 2)) fill_side<1>({f}, side(f, face), kind(face) == BoundaryKind::periodic, kCopy);
}

void Boundaries::fill_velocity(std::array<FieldView, 3> u, const std::array<FieldView, 3>& q) const {
  for (int face = 0; face < 6; ++face) {
    if (!grid_.active(face / 2)) continue;
    const Side s = side(u[0], face);
    const std::size_t d = static_cast<std::size_t>(s.d);
    const Plane& plane = planes_[static_cast<std::size_t>(face)];
    const std::array<const Real*, 3> given{plane.velocity[0].data(), plane.velocity[1].data(),
                                           plane.velocity[2].data()};
    const std::ptrdiff_t na = plane.na;
    switch (kind(face)) {
      case BoundaryKind::periodic:
        fill_side(u, s, true, kCopy);
        break;
      case BoundaryKind::mirror:
        fill_side(u, s, false,
                  [d](auto c, int, int, int, std::ptrdiff_t, Real inner) { return c == d ? -inner : inner; });
        break;
      case BoundaryKind::open:
        // Fluid that comes in through an open boundary brings no tangential momentum.
        decide(faces_[static_cast<std::size_t>(face)].discs, [&](auto discs) {
          const char* prescribed = plane.prescribed.data();
          fill_side(
              u, s, false,
              [ =, out = out_through(q, s) ](auto c, int, int a, int b, std::ptrdiff_t, Real inner)
                  __attribute__((always_inline)) {
                    const Real through = out(a, b);
                    const Real in = c == d ? (s.upper ? Real(2) : Real(-2)) * through - inner : -inner;
                    const Real ghost = through < 0 ? in : inner;
                    if constexpr (!discs) return ghost;
                    else return prescribed[b * na + a] ? Real(2) * given[c][b * na + a] - inner : ghost;
                  });
        });
        break;
      default:
        fill_side(
            u, s,
            false, [=](auto c, int, int a, int b, std::ptrdiff_t, Real inner) __attribute__((always_inline)) {
              return Real(2) * given[c][b * na + a] - inner;
            });
    }
  }
}

void Boundaries::fill_pressure(FieldView p, const std::array<FieldView, 3>& q, bool total) const {
  for (int face = 0; face < 6; ++face) {
    if (!grid_.active(face / 2)) continue;
    const Boundary& boundary = (*this)[face];
    const Side s = side(p, face);
    if (boundary.kind == BoundaryKind::mirror || boundary.kind == BoundaryKind::periodic) {
      fill_side<1>({p}, s, boundary.kind == BoundaryKind::periodic, kCopy);
      continue;
    }
    // Linear extrapolation keeps the pressure force second-order next to walls and inflows.
    const Metrics m = grid_.metrics(s.d);
    const int n = grid_.n(s.d), cell = s.upper ? n - 1 : 0, next = s.upper ? n - 2 : 1;
    const Real inv_distance = s.upper ? m.inv_distance[n - 1] : m.inv_distance[1];
    const std::array<Real, kGhosts> distance{m.width[cell],
                                             Real(1.5) * m.width[cell] + Real(0.5) * m.width[next]};
    const Real* origin = p.origin;
    const auto extrapolated = [=](int layer, std::ptrdiff_t at) {
      return origin[at] +
             (origin[at] - origin[at - s.outward]) * inv_distance * distance[static_cast<std::size_t>(layer)];
    };
    if (boundary.kind == BoundaryKind::open) {
      const Real dynamic = total && boundary.total_pressure ? Real(0.5) : Real(0);
      const Real given = total ? Real(1) : Real(0);
      const Plane& plane = planes_[static_cast<std::size_t>(face)];
      decide(boundary.discs, [&](auto discs) {
        fill_side<1>(
            {p}, s, false,
            [
              =, out = out_through(q, s), pressure = plane.pressure.data(),
              prescribed = plane.prescribed.data(), na = std::ptrdiff_t(plane.na)
            ](auto, int layer, int a, int b, std::ptrdiff_t cell_at, Real inner)
                __attribute__((always_inline)) {
                  const Real through = out(a, b);
                  const Real entering = through < 0 ? dynamic * through * through : Real(0);
                  const Real ghost = Real(2) * (given * pressure[b * na + a] - entering) - inner;
                  if constexpr (!discs) return ghost;
                  else return prescribed[b * na + a] ? extrapolated(layer, cell_at) : ghost;
                });
      });
    } else {
      fill_side<1>(
          {p}, s,
          false, [=](auto, int layer, int, int, std::ptrdiff_t cell_at, Real) __attribute__((always_inline)) {
            return extrapolated(layer, cell_at);
          });
    }
  }
}

void Boundaries::fill_turbulence(FieldView k, FieldView dissipation,
                                 const std::array<FieldView, 3>& q) const {
  const std::array<FieldView, 2> both{k, dissipation};
  for (int face = 0; face < 6; ++face) {
    if (!grid_.active(face / 2)) continue;
    const Side s = side(k, face);
    if (kind(face) != BoundaryKind::inflow && kind(face) != BoundaryKind::open) {
      fill_side(both, s, kind(face) == BoundaryKind::periodic, kCopy);
      continue;
    }
    const Plane& plane = planes_[static_cast<std::size_t>(face)];
    fill_side(
        both, s, false, [
          out = out_through(q, s), energy = plane.k.data(), dissipated = plane.dissipation.data(),
          na = std::ptrdiff_t(plane.na)
        ](auto c, int, int a, int b, std::ptrdiff_t, Real inner) __attribute__((always_inline)) {
          const Real given = energy[b * na + a];
          const Real in = c == 0 ? given : dissipated[b * na + a];
          return out(a, b) < 0 && given > 0 ? in : inner;
        });
  }
}

void Boundaries::prescribe_face_velocity(std::array<FieldView, 3> q) const {
  for (int face = 0; face < 6; ++face) {
    const int d = face / 2;
    const BoundaryKind kind = this->kind(face);
    if (!grid_.active(d) || kind == BoundaryKind::periodic || kind == BoundaryKind::open) continue;
    const Plane& plane = planes_[static_cast<std::size_t>(face)];
    for_each_index(plane.nb, [&](int b) {
      for (int a = 0; a < plane.na; ++a) {
        const auto [i, j, k] = on_face(face, a, b);
        q[d](i, j, k) =
            kind == BoundaryKind::mirror ? Real(0) : at(face, a, b).velocity[static_cast<std::size_t>(d)];
      }
    });
  }
  for_each_prescribed([&q](int d, const std::array<int, 3>& f, const BoundaryState& state) {
    q[static_cast<std::size_t>(d)](f[0], f[1], f[2]) = state.velocity[static_cast<std::size_t>(d)];
  });
}

void Boundaries::fill_face_velocity(std::array<FieldView, 3> q, const std::array<FieldView, 3>& u_star,
                                    ConstFieldView p, Real dt) const {
  prescribe_face_velocity(q);
  for (int face = 0; face < 6; ++face) {
    const int d = face / 2, n = grid_.n(d), cell = face % 2 ? n - 1 : 0;
    if (!grid_.active(d) || kind(face) != BoundaryKind::open) continue;
    const Metrics m = grid_.metrics(d);
    const Plane& plane = planes_[static_cast<std::size_t>(face)];
    for_each_index(plane.nb, [&](int b) {
      for (int a = 0; a < plane.na; ++a) {
        if (prescribed(face, a, b)) continue;
        const Index f = index_on(d, a, b, face % 2 ? n : 0), in = index_on(d, a, b, cell);
        const Real* pc = &p(in.i, in.j, in.k);
        const std::ptrdiff_t s = stride(p, d);
        const Real low = m.weight[cell] * pc[-s] + (Real(1) - m.weight[cell]) * pc[0];
        const Real high = m.weight[cell + 1] * pc[0] + (Real(1) - m.weight[cell + 1]) * pc[s];
        const Real at_cell = (high - low) / m.width[cell];
        const Real at_face =
            face % 2 ? (pc[s] - pc[0]) * m.inv_distance[n] : (pc[0] - pc[-s]) * m.inv_distance[0];
        q[d](f.i, f.j, f.k) = u_star[d](in.i, in.j, in.k) + dt * (at_cell - at_face);
      }
    });
  }
}

}  // namespace ejecta
