#pragma once
#include "base/vec.hpp"

namespace ejecta {

/// What acts on a body from outside the DEM (the fluid), world axes, about the centre of mass.
struct Load {
  Vec3 force{0, 0, 0};   ///< N
  Vec3 torque{0, 0, 0};  ///< N m
};

}  // namespace ejecta
