#include <cmath>

#include "flow/cut_geometry.hpp"
#include "flow/piso/cut_flow.hpp"

/// CutFlow: velocities on the faces of cut cells, and what the pressure makes of them and of the cells.
namespace ejecta {
namespace {

using Cell = std::array<int, 3>;
using Triple = std::array<Real, 3>;

/// Closed faces move with their solid.
void hold_closed(const CutCells& cut, const std::array<FieldView, 3>& q) {
  for_each_index(static_cast<int>(cut.faces.size()), [&](int n) {
    const CutFace& f = cut.faces[static_cast<std::size_t>(n)];
    if (f.closed >= Real(1)) q[static_cast<std::size_t>(f.d)](f.i, f.j, f.k) = f.velocity;
  });
}

}  // namespace

Real CutFlow::to_middle_of_open(const Grid& grid, const CutCells& cut, int d, const Cell& face,
                                ConstFieldView u) {
  const std::size_t s = static_cast<std::size_t>(d);
  const Real w = grid.metrics(d).weight[face[s]], closed = cut.closed[s](face[0], face[1], face[2]);
  if (closed <= Real(0) || closed >= Real(1)) return 0;
  const auto below = [s](Cell at) {
    --at[s];
    return at;
  };
  const auto between = [&](const Cell& at) {
    const Cell low = below(at);
    return w * u(low[0], low[1], low[2]) + (Real(1) - w) * u(at[0], at[1], at[2]);
  };
  Triple normal{0, 0, 0};
  for (const Cell& side : {below(face), face}) {
    const int index = cut.index(side[0], side[1], side[2]);
    for (std::size_t e = 0; index > 0 && e < 3; ++e)
      if (e != s && grid.active(int(e)))
        normal[e] += cut.cells[static_cast<std::size_t>(index - 1)].normal[e];
  }
  const Real length = std::abs(normal[0]) + std::abs(normal[1]) + std::abs(normal[2]);
  Real change = 0;
  for (std::size_t e = 0; e < 3; ++e) {
    if (normal[e] == Real(0)) continue;
    Cell next = face;
    next[e] += normal[e] > 0 ? 1 : -1;
    const Cell low = below(next);
    if (next[e] < 0 || next[e] >= grid.n(int(e)) || cut.index(next[0], next[1], next[2]) < 0 ||
        cut.index(low[0], low[1], low[2]) < 0 || cut.closed[s](next[0], next[1], next[2]) >= Real(1))
      continue;
    change += Real(0.5) * closed * std::abs(normal[e]) / length * (between(next) - between(face));
  }
  return change;
}

void CutFlow::face_velocities(const CutCells& cut, const std::array<ConstFieldView, 3>& u, ConstFieldView p,
                              Real filter_time, const std::array<FieldView, 3>& q) {
  for_each_index(static_cast<int>(cut.cells.size()), [&](int n) {
    const CutCell& c = cut.cells[static_cast<std::size_t>(n)];
    if (c.carrier == n) gradient_[static_cast<std::size_t>(n)] = gradient(c, p).value;
  });
  // The pressure gradient that moved a cell; false where none did of its own.
  const auto gradient_at = [&](const Cell& c, int d, Real& value) {
    const int index = cut.index(c[0], c[1], c[2]);
    if (index == 0) {
      const Real* at = &p(c[0], c[1], c[2]);
      value = cell_gradient(at, stride(p, d), grid_.metrics(d), c[static_cast<std::size_t>(d)]);
      return true;
    }
    if (index < 0) return false;
    if (cut.cells[static_cast<std::size_t>(index - 1)].carrier != index - 1) return false;
    value = gradient_[static_cast<std::size_t>(index - 1)][static_cast<std::size_t>(d)];
    return true;
  };
  const auto roughness = [&](int d, const Cell& face, Real& value) {
    const std::size_t s = static_cast<std::size_t>(d);
    Real below = 0, above = 0;
    if (face[s] <= 0 || face[s] >= grid_.n(d) || cut.closed[s](face[0], face[1], face[2]) >= Real(1))
      return false;
    Cell low = face;
    --low[s];
    if (!gradient_at(low, d, below) || !gradient_at(face, d, above)) return false;
    const Metrics& m = grid_.metrics(d);
    const Real w = m.weight[face[s]];
    value = w * below + (Real(1) - w) * above -
            (p(face[0], face[1], face[2]) - p(low[0], low[1], low[2])) * m.inv_distance[face[s]];
    return true;
  };
  const auto set = [&](int d, const Cell& face) {
    const std::size_t s = static_cast<std::size_t>(d);
    if (face[s] <= 0 || face[s] >= grid_.n(d)) return;  // of the box
    Cell low = face;
    --low[s];
    const Real w = grid_.metrics(d).weight[face[s]];
    const Real velocity = w * u[s](low[0], low[1], low[2]) + (Real(1) - w) * u[s](face[0], face[1], face[2]) +
                          to_middle_of_open(grid_, cut, d, face, u[s]);
    // As in face_velocities() of the whole grid; not on the last face before a wall, where the gradient of
    // the cell is one-sided and its roughness is not that of p.
    Cell below = face, above = face;
    --below[s];
    ++above[s];
    Real filter = 0, here = 0, low_face = 0, high_face = 0;
    if (roughness(d, face, here) && roughness(d, below, low_face) && roughness(d, above, high_face))
      filter = Real(0.5) * here - Real(0.25) * (low_face + high_face);
    q[s](face[0], face[1], face[2]) = velocity + filter_time * filter;
  };
  for_each_index(static_cast<int>(cut.cells.size()), [&](int n) {
    const CutCell& c = cut.cells[static_cast<std::size_t>(n)];
    for (int d = 0; d < 3; ++d) {
      if (!grid_.active(d)) continue;
      Cell face{c.i, c.j, c.k};
      set(d, face);
      const std::size_t s = static_cast<std::size_t>(d);
      ++face[s];
      // The cell above sets its lower face itself when it is cut.
      if (face[s] < grid_.n(d) && cut.index(face[0], face[1], face[2]) <= 0) set(d, face);
    }
  });
  hold_closed(cut, q);
}

void CutFlow::end_velocities(const CutCells& cut, const OpenFace& open,
                             const std::array<ConstFieldView, 3>& u, ConstFieldView p, Real dt,
                             const std::array<FieldView, 3>& q) const {
  for_each_index(static_cast<int>(cut.cells.size()), [&](int n) {
    const CutCell& c = cut.cells[static_cast<std::size_t>(n)];
    if (c.carrier < 0) return;
    const Cell at{c.i, c.j, c.k};
    for (int side = 0; side < 6; ++side) {
      const int d = side / 2;
      const std::size_t s = static_cast<std::size_t>(d);
      Cell face = at;
      face[s] += side % 2;
      if (!grid_.active(d) || face[s] != (side % 2 ? grid_.n(d) : 0) || !open(side, face)) continue;
      // Of a small cell that of its carrier: they share one pressure, which could not stop what circles
      // through two open ends of one cell.
      const CutCell& mover = cut.cells[static_cast<std::size_t>(c.carrier)];
      const Real* above = &p(face[0], face[1], face[2]);
      const Real at_face = (above[0] - above[-stride(p, d)]) * grid_.metrics(d).inv_distance[face[s]];
      q[s](face[0], face[1], face[2]) = u[s](mover.i, mover.j, mover.k) +
                                        dt * (gradient_[static_cast<std::size_t>(c.carrier)][s] - at_face);
    }
  });
}

void CutFlow::close(const CutCells& cut, const std::array<FieldView, 3>& q) {
  open_velocity_.resize(cut.faces.size());
  for_each_index(static_cast<int>(cut.faces.size()), [&](int n) {
    const CutFace& f = cut.faces[static_cast<std::size_t>(n)];
    Real& velocity = q[static_cast<std::size_t>(f.d)](f.i, f.j, f.k);
    open_velocity_[static_cast<std::size_t>(n)] = velocity;
    velocity += f.closed * (f.velocity - velocity);
  });
}

void CutFlow::reopen(const CutCells& cut, const std::array<FieldView, 3>& q) const {
  for_each_index(static_cast<int>(cut.faces.size()), [&](int n) {
    const CutFace& f = cut.faces[static_cast<std::size_t>(n)];
    q[static_cast<std::size_t>(f.d)](f.i, f.j, f.k) = open_velocity_[static_cast<std::size_t>(n)];
  });
}

void CutFlow::keep(const CutCells& cut, const std::array<ConstFieldView, 3>& u) {
  for_each_index(static_cast<int>(cut.cells.size()), [&](int n) {
    const CutCell& c = cut.cells[static_cast<std::size_t>(n)];
    for (std::size_t e = 0; e < 3; ++e) kept_[static_cast<std::size_t>(n)][e] = u[e](c.i, c.j, c.k);
  });
}

void CutFlow::correct(const CutCells& cut, ConstFieldView phi, Real dt, const std::array<FieldView, 3>& q,
                      const std::array<FieldView, 3>& u) {
  hold_closed(cut, q);
  push_thin(cut, phi, dt);
  for_each_index(static_cast<int>(cut.cells.size()), [&](int n) {
    const CutCell& c = cut.cells[static_cast<std::size_t>(n)];
    if (c.carrier != n) return;
    const Triple g = gradient(c, phi).value;
    for (std::size_t e = 0; e < 3; ++e)
      u[e](c.i, c.j, c.k) = kept_[static_cast<std::size_t>(n)][e] - dt * g[e];
  });
}

}  // namespace ejecta
