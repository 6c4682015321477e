#pragma once
#include <vector>

#include "shape/polytope.hpp"
#include "shape/shape.hpp"

namespace ejecta {

/// A shape of convex parts, in the user's axes, with its surface and mass properties.
Shape make_polytope_shape(std::vector<Polytope> parts, TriangleMesh surface, const MassProperties& mass);

}  // namespace ejecta
