#pragma once
#include <array>

#include "flow/solid_mask.hpp"
#include "grid/grid.hpp"

namespace ejecta {

/// Gives the cells of solids their velocity (m/s): the solid's, or what an image point in the fluid says
/// (ghost cells). What that takes is added to `solids.impulse`, times `weight`: m3 m/s.
void force_solids(const Grid& grid, SolidMask& solids, double weight, std::array<FieldView, 3> u);

/// Faces of solid cells: the plain mean of the two cells, since the pressure inside a solid must not move the
/// faces of the fluid; between two cells inside it the rigid velocity itself.
/// `inside_solid`: forcing weight of every cell, zero in the fluid. `q`: velocity through faces, m/s.
void face_velocities_at_solids(const Grid& grid, const SolidMask& solids, ConstFieldView inside_solid,
                               std::array<ConstFieldView, 3> u, std::array<FieldView, 3> q);

}  // namespace ejecta
