#pragma once
#include "shape/shape.hpp"

namespace ejecta {

/// Triangles of the zero level of the shape's signed distance: one vertex in each crossed cell of a cube
/// lattice of spacing h, pulled onto the surface ("surface nets", Gibson 1998). Closed.
TriangleMesh surface_nets(const Shape& shape, double h);

}  // namespace ejecta
