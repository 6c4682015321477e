#pragma once
#include <variant>
#include <vector>

#include "shape/polytope.hpp"
#include "shape/shape.hpp"

namespace ejecta {

struct BallsGeometry {
  std::vector<Ball> balls;
};
struct BoxGeometry {
  Vec3 half;                    ///< m, half edge lengths
  std::vector<Polytope> parts;  ///< one
};
/// Convex parts that do not overlap: a polyhedron, or a mesh of several closed convex pieces.
struct PolytopesGeometry {
  std::vector<Polytope> parts;
  TriangleMesh surface;
};

/// What a Shape holds; in body axes.
struct ShapeData {
  std::variant<BallsGeometry, BoxGeometry, PolytopesGeometry> geometry;
  MassProperties mass;
  BodyFrame frame;
  double bounding_radius = 0.0;
  double smallest_feature = 0.0;
};

}  // namespace ejecta
