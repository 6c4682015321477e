#pragma once
#include <array>

#include "flow/solid_mask.hpp"
#include "grid/grid.hpp"

namespace ejecta {

/// `solids.target`: the velocity (m/s) of each of their cells, the solid's or what an image point in the
/// fluid says (ghost cells).
void aim_at_solids(SolidMask& solids, const std::array<ConstFieldView, 3>& u);

/// Gives the cells of solids their target velocity (m/s). What that takes of a fluid of `density` (kg/m3) is
/// added to `solids.impulse`, N s.
void force_solids(const Grid& grid, SolidMask& solids, double density, std::array<FieldView, 3> u);

/// visit(solid cell, axis of the face, cell below, cell above, the one of them beyond the face) for every
/// face of solid cells inside the box; twice for a face between two of them.
template <class Visit>
void for_each_face_of_solids(const Grid& grid, const SolidMask& solids, const Visit& visit) {
  for_each_index(static_cast<int>(solids.cells.size()), [&](int n) {
    const SolidCell& c = solids.cells[static_cast<std::size_t>(n)];
    const std::array<int, 3> here{c.i, c.j, c.k};
    for (std::size_t d = 0; d < 3; ++d) {
      if (!grid.active(int(d))) continue;
      std::array<int, 3> below = here, above = here;
      --below[d];
      ++above[d];
      if (below[d] >= 0) visit(c, int(d), below, here, below);
      if (above[d] < grid.n(int(d))) visit(c, int(d), here, above, above);
    }
  });
}

}  // namespace ejecta
