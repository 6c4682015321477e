#pragma once
#include <array>

#include "flow/boundary.hpp"

namespace ejecta {

/// What boundary states that change with time do within a step. Both numbers are Courant numbers: of the
/// velocities the boundaries prescribe, and of the one that a change of pressure can give, sqrt(2 dp / rho).
struct BoundaryChange {
  double reached = 0.0;  ///< with the velocities that the boundaries have within the step
  double changed = 0.0;  ///< with their changes
};

/// Looks at the states at some times of the step from `time` to `time + dt`.
BoundaryChange boundary_change(const Grid& grid, const std::array<Boundary, 6>& faces, double time,
                               double dt);

}  // namespace ejecta
