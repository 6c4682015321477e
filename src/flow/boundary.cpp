#include "flow/boundary.hpp"

#include <algorithm>

#include "flow/stencil.hpp"

namespace ejecta {
namespace {

/// Cell indices on a face normal to d, from in-plane indices and the index along d.
struct Index {
  int i, j, k;
};

Index index_on(int d, int a, int b, int along) {
  if (d == 0) return {along, a, b};
  if (d == 1) return {b, along, a};
  return {a, b, along};
}

}  // namespace

Boundaries::Boundaries(const Grid& grid, std::array<Boundary, 6> faces)
    : grid_(grid), faces_(std::move(faces)) {
  for (int face = 0; face < 6; ++face) {
    const int d = face / 2;
    Plane& p = planes_[static_cast<std::size_t>(face)];
    p.na = grid.n((d + 1) % 3);
    p.nb = grid.n((d + 2) % 3);
    p.states.resize(static_cast<std::size_t>(p.na) * static_cast<std::size_t>(p.nb));
  }
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
    const int d = face / 2, da = (d + 1) % 3, db = (d + 2) % 3;
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

/// ghost(face, a, b, inner, layer, outflow...) -> value; directions in order, each including the ghosts
/// already set, so that edges are filled too.
template <class Ghost>
void Boundaries::fill(FieldView f, const Ghost& ghost) const {
  for (int d = 0; d < 3; ++d) {
    if (!grid_.active(d)) continue;
    const int da = (d + 1) % 3, db = (d + 2) % 3, n = grid_.n(d);
    const int ga = da < d && grid_.active(da) ? kGhosts : 0, gb = db < d && grid_.active(db) ? kGhosts : 0;
    const int na = grid_.n(da), nb = grid_.n(db);
    for (int side = 0; side < 2; ++side) {
      const int face = 2 * d + side;
      const bool periodic = kind(face) == BoundaryKind::periodic;
      for_each_index(nb + 2 * gb, [&, face](int row) {
        const int b = row - gb;
        for (int a = -ga; a < na + ga; ++a)
          for (int layer = 0; layer < kGhosts; ++layer) {
            const Index out = index_on(d, a, b, side ? n + layer : -1 - layer);
            const int source = periodic ? (side ? layer : n - 1 - layer) : (side ? n - 1 - layer : layer);
            const Index in = index_on(d, a, b, std::clamp(source, 0, n - 1));
            const Real inner = f(in.i, in.j, in.k);
            f(out.i, out.j, out.k) = periodic
                                         ? inner
                                         : ghost(face, std::clamp(a, 0, na - 1), std::clamp(b, 0, nb - 1),
                                                 inner, layer, std::array<int, 3>{a, b, n});
          }
      });
    }
  }
}

void Boundaries::fill_zero_gradient(FieldView f) const {
  fill(f, [](int, int, int, Real inner, int, const std::array<int, 3>&) { return inner; });
}

void Boundaries::fill_velocity(std::array<FieldView, 3> u, const std::array<FieldView, 3>& q) const {
  for (int c = 0; c < 3; ++c)
    fill(u[c], [&, c](int face, int a, int b, Real inner, int, const std::array<int, 3>& at) -> Real {
      const int d = face / 2;
      switch (kind(face)) {
        case BoundaryKind::mirror:
          return c == d ? -inner : inner;
        case BoundaryKind::open: {
          // Fluid that comes in through an open boundary brings no tangential momentum.
          const Index f = index_on(d, a, b, face % 2 ? at[2] : 0);
          const Real through = q[d](f.i, f.j, f.k);
          const bool enters = face % 2 ? through < 0 : through > 0;
          if (!enters) return inner;
          return c == d ? Real(2) * through - inner : -inner;
        }
        default:
          return Real(2) * this->at(face, a, b).velocity[c] - inner;
      }
    });
}

void Boundaries::fill_pressure(FieldView p, const std::array<FieldView, 3>& q, bool total) const {
  fill(p, [&](int face, int a, int b, Real inner, int layer, const std::array<int, 3>& at) -> Real {
    const Boundary& boundary = (*this)[face];
    const int d = face / 2, n = at[2];
    if (boundary.kind == BoundaryKind::mirror) return inner;
    if (boundary.kind == BoundaryKind::open) {
      Real fixed = 0;
      if (total) {
        fixed = static_cast<Real>(boundary.pressure);
        if (boundary.total_pressure) {
          const Index f = index_on(d, a, b, face % 2 ? n : 0);
          const Real through = q[d](f.i, f.j, f.k);
          if (face % 2 ? through < 0 : through > 0) fixed -= Real(0.5) * through * through;
        }
      }
      return Real(2) * fixed - inner;
    }
    // Linear extrapolation keeps the pressure force second-order next to walls and inflows.
    if (n < 2) return inner;
    const Metrics m = grid_.metrics(d);
    const Index i0 = index_on(d, at[0], at[1], face % 2 ? n - 1 : 0);
    const Index i1 = index_on(d, at[0], at[1], face % 2 ? n - 2 : 1);
    const Real p0 = p(i0.i, i0.j, i0.k), p1 = p(i1.i, i1.j, i1.k);
    const Real slope = (p0 - p1) * (face % 2 ? m.inv_distance[n - 1] : m.inv_distance[1]);
    const int cell = face % 2 ? n - 1 : 0;
    const int next = face % 2 ? n - 2 : 1;
    const Real distance = layer == 0 ? m.width[cell] : Real(1.5) * m.width[cell] + Real(0.5) * m.width[next];
    return p0 + slope * distance;
  });
}

void Boundaries::fill_turbulence(FieldView k, FieldView second, const std::array<FieldView, 3>& q) const {
  for (int v = 0; v < 2; ++v)
    fill(v == 0 ? k : second,
         [&, v](int face, int a, int b, Real inner, int, const std::array<int, 3>& at) -> Real {
           const int d = face / 2;
           if (kind(face) != BoundaryKind::inflow && kind(face) != BoundaryKind::open) return inner;
           const BoundaryState& state = this->at(face, a, b);
           const Index f = index_on(d, a, b, face % 2 ? at[2] : 0);
           const Real through = q[d](f.i, f.j, f.k);
           const bool enters = face % 2 ? through < 0 : through > 0;
           if (!enters || state.k <= 0) return inner;
           return v == 0 ? state.k : state.second;
         });
}

void Boundaries::prescribe_face_velocity(std::array<FieldView, 3> q) const {
  for (int face = 0; face < 6; ++face) {
    const int d = face / 2;
    const BoundaryKind kind = this->kind(face);
    if (!grid_.active(d) || kind == BoundaryKind::periodic || kind == BoundaryKind::open) continue;
    const Plane& plane = planes_[static_cast<std::size_t>(face)];
    for_each_index(plane.nb, [&](int b) {
      for (int a = 0; a < plane.na; ++a) {
        const Index f = index_on(d, a, b, face % 2 ? grid_.n(d) : 0);
        q[d](f.i, f.j, f.k) =
            kind == BoundaryKind::mirror ? Real(0) : at(face, a, b).velocity[static_cast<std::size_t>(d)];
      }
    });
  }
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
