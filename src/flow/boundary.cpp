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

Boundaries::Boundaries(const Grid& grid, std::array<Boundary, 6> faces)
    : grid_(grid), faces_(std::move(faces)) {
  for (int face = 0; face < 6; ++face) {
    const int d = face / 2;
    Plane& p = planes_[static_cast<std::size_t>(face)];
    p.na = grid.n(first_across(d));
    p.nb = grid.n(second_across(d));
    p.states.resize(static_cast<std::size_t>(p.na) * static_cast<std::size_t>(p.nb));
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
        p.states[static_cast<std::size_t>(b) * static_cast<std::size_t>(p.na) + static_cast<std::size_t>(a)] =
            boundary.state(x, time);
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

/// ghost(field, layer, a, b, cell, inner) -> value of a ghost; a and b clamped to the face, `cell` the offset
/// of the boundary cell, `inner` the value as far inside as the ghost is outside (periodic: on the other
/// side).
template <std::size_t kN, class Ghost>
void Boundaries::fill_side(const std::array<FieldView, kN>& fields, const Side& s, bool periodic,
                           const Ghost& ghost) const {
  const int n = grid_.n(s.d);
  for_each_index(s.nb + 2 * s.ghosts_b, [&](int row) {
    const int b = std::clamp(row - s.ghosts_b, 0, s.nb - 1);
    const std::ptrdiff_t start = s.cell(0, row - s.ghosts_b);
    for (std::size_t c = 0; c < kN; ++c)
      for (int layer = 0; layer < kGhosts; ++layer) {
        Real* origin = fields[c].origin;
        const std::ptrdiff_t out = (layer + 1) * s.outward,
                             in = -(periodic ? n - 1 - layer : layer) * s.outward;
        for (int a = -s.ghosts_a; a < s.na + s.ghosts_a; ++a) {
          const std::ptrdiff_t cell = start + a * s.step_a;
          origin[cell + out] = ghost(c, layer, std::clamp(a, 0, s.na - 1), b, cell, origin[cell + in]);
        }
      }
  });
}

namespace {

/// A copy of the value inside.
constexpr auto kCopy = [](std::size_t, int, int, int, std::ptrdiff_t, Real inner) { return inner; };

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
    const Real* through_face = q[d].origin + s.face;
    switch (kind(face)) {
      case BoundaryKind::periodic:
        fill_side(u, s, true, kCopy);
        break;
      case BoundaryKind::mirror:
        fill_side(u, s, false, [d](std::size_t c, int, int, int, std::ptrdiff_t, Real inner) {
          return c == d ? -inner : inner;
        });
        break;
      case BoundaryKind::open:
        // Fluid that comes in through an open boundary brings no tangential momentum.
        fill_side(u, s, false, [=, this](std::size_t c, int, int a, int b, std::ptrdiff_t, Real inner) {
          if (prescribed(face, a, b)) return Real(2) * at(face, a, b).velocity[c] - inner;
          const Real through = through_face[s.cell(a, b)];
          const bool enters = s.upper ? through < 0 : through > 0;
          return !enters ? inner : c == d ? Real(2) * through - inner : -inner;
        });
        break;
      default:
        fill_side(u, s, false, [=, this](std::size_t c, int, int a, int b, std::ptrdiff_t, Real inner) {
          return Real(2) * at(face, a, b).velocity[c] - inner;
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
      const Real* through_face = q[static_cast<std::size_t>(s.d)].origin + s.face;
      fill_side<1>({p}, s, false,
                   [=, this](std::size_t, int layer, int a, int b, std::ptrdiff_t cell_at, Real inner) {
                     if (prescribed(face, a, b)) return extrapolated(layer, cell_at);
                     const Real fixed = total ? at(face, a, b).pressure : Real(0);
                     const Real through = through_face[s.cell(a, b)];
                     const bool enters = s.upper ? through < 0 : through > 0;
                     return Real(2) * (fixed - (enters ? dynamic * through * through : Real(0))) - inner;
                   });
    } else {
      fill_side<1>({p}, s, false, [=](std::size_t, int layer, int, int, std::ptrdiff_t cell_at, Real) {
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
    const Real* through_face = q[static_cast<std::size_t>(s.d)].origin + s.face;
    fill_side(both, s, false, [=, this](std::size_t c, int, int a, int b, std::ptrdiff_t, Real inner) {
      const Real through = through_face[s.cell(a, b)];
      const BoundaryState& state = at(face, a, b);
      const bool enters = s.upper ? through < 0 : through > 0;
      return !enters || state.k <= 0 ? inner : c == 0 ? state.k : state.dissipation;
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
