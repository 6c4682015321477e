#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "flow/cut_cells.hpp"
#include "flow/stencil.hpp"

/// What every operator of cut cells asks of them.
namespace ejecta {

using GridMetrics = std::array<Metrics, 3>;
/// Area of the lower d-face of cell `at`, m2.
inline Real face_area_of(const GridMetrics& m, int d, const std::array<int, 3>& at) {
  const std::size_t s = static_cast<std::size_t>(d), a = (s + 1) % 3, b = (s + 2) % 3;
  return m[s].area[at[s]] * m[a].volume[at[a]] * m[b].volume[at[b]];
}

/// visit(cell, d, face, neighbour, sign, open part, whole area) for the open faces of one cell; sign: +1
/// where the face is its upper one.
template <class Visit>
void for_each_open_face_of(const Grid& grid, const CutCells& cut, const CutCell& c, const Visit& visit) {
  for (int side = 0; side < 6; ++side) {
    const int d = side / 2, up = side % 2;
    if (!grid.active(d)) continue;
    std::array<int, 3> face{c.i, c.j, c.k}, beyond = face;
    face[static_cast<std::size_t>(d)] += up;
    beyond[static_cast<std::size_t>(d)] += up ? 1 : -1;
    const Real open = Real(1) - cut.closed[static_cast<std::size_t>(d)](face[0], face[1], face[2]);
    if (open > Real(0))
      visit(c, d, face, beyond, up ? Real(1) : Real(-1), open, face_area_of(grid.metrics(), d, face));
  }
}

/// The same for a carrier and the cells it carries.
template <class Visit>
void for_each_open_face(const Grid& grid, const CutCells& cut, const CutCell& carrier, const Visit& visit) {
  for (int n = carrier.first_member; n < carrier.first_member + carrier.members; ++n)
    for_each_open_face_of(
        grid, cut, cut.cells[static_cast<std::size_t>(cut.members[static_cast<std::size_t>(n)])], visit);
}

/// visit(cell, its carrier) for the small cells, one after the other.
template <class Visit>
void for_each_small(const CutCells& cut, const Visit& visit) {
  for (std::size_t n = 0; n < cut.cells.size(); ++n)
    if (cut.small(n)) visit(cut.cells[n], cut.cells[static_cast<std::size_t>(cut.cells[n].carrier)]);
}

/// visit(wall, its index) for the walls of a carrier and of the cells it carries.
template <class Visit>
void for_each_wall(const CutCells& cut, const CutCell& carrier, const Visit& visit) {
  for (int n = carrier.first_member; n < carrier.first_member + carrier.members; ++n) {
    const CutCell& c = cut.cells[static_cast<std::size_t>(cut.members[static_cast<std::size_t>(n)])];
    for (int w = c.first_wall; w < c.first_wall + c.walls; ++w)
      visit(cut.walls[static_cast<std::size_t>(w)], w);
  }
}

inline Real dot(const std::array<Real, 3>& a, const std::array<Real, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Real norm(const std::array<Real, 3>& v) { return std::sqrt(dot(v, v)); }

/// Width of a cell along its normal, m.
inline Real width_along_normal(const Grid& grid, const CutCell& c) {
  const int at[3] = {c.i, c.j, c.k};
  Real width = 0;
  for (std::size_t d = 0; d < 3; ++d)
    if (grid.active(int(d))) width += std::abs(c.normal[d]) * grid.metrics(int(d)).width[at[d]];
  return width > Real(0) ? width : grid.metrics(0).width[c.i];
}

/// Distance from the wall at which the velocity of a carrier stands in the law of the wall, m: being that of
/// its fluid as a whole, it stands for the middle between the wall and the far side.
inline Real wall_distance(const Grid& grid, const CutCell& carrier) {
  return Real(0.5) * (std::max(carrier.distance, Real(0)) + Real(0.5) * width_along_normal(grid, carrier));
}

/// Velocity of the body that a wall belongs to, were it to reach out by y, m/s. What shears the fluid there
/// is its velocity relative to this: a body that turns with the fluid around it feels nothing.
inline std::array<Real, 3> carried_on(const CutWall& wall, Real y) {
  const Real area = std::max(norm(wall.area), Real(1e-30));
  const std::array<Real, 3>&s = wall.spin, &a = wall.area;  // out of the fluid
  return {wall.velocity[0] - y / area * (s[1] * a[2] - s[2] * a[1]),
          wall.velocity[1] - y / area * (s[2] * a[0] - s[0] * a[2]),
          wall.velocity[2] - y / area * (s[0] * a[1] - s[1] * a[0])};
}

/// The part of w along a wall of this area.
inline std::array<Real, 3> along_wall(std::array<Real, 3> w, const std::array<Real, 3>& area) {
  const Real through = dot(w, area) / std::max(dot(area, area), Real(1e-30));
  for (std::size_t e = 0; e < 3; ++e) w[e] -= through * area[e];
  return w;
}

}  // namespace ejecta
