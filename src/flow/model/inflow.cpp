#include "flow/model/inflow.hpp"

namespace ejecta {

Vec3 half_widths(const Grid& grid, const Vec3& x) {
  Vec3 half;
  for (int d = 0; d < 3; ++d) {
    const Axis& a = grid.axis(d);
    half[d] = 0.5 * a.width[static_cast<std::size_t>(a.cell_at(x[d]))];
  }
  if (grid.axisymmetric()) half.y() = 0.0;
  return half;
}

double width_inside(const Grid& grid, int face) {
  const Axis& a = grid.axis(face / 2);
  return face % 2 ? a.width.back() : a.width.front();
}

}  // namespace ejecta
