#pragma once
#include <variant>
#include <vector>

#include "shape/shape.hpp"

namespace ejecta {

struct BoxGeometry {
  Vec3 half;  ///< m, half edge lengths
};
struct BallsGeometry {
  std::vector<Ball> balls;
};

/// What a Shape holds; in body axes.
struct ShapeData {
  std::variant<BallsGeometry, BoxGeometry> geometry;
  MassProperties mass;
  BodyFrame frame;
  double bounding_radius = 0.0;
  double smallest_feature = 0.0;
};

}  // namespace ejecta
