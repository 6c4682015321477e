#pragma once
#include <vector>

#include "shape/mass_properties.hpp"

/// Geometry of a union of balls and of a box, in body axes.
namespace ejecta {

double distance_balls(const std::vector<Ball>& balls, const Vec3& p);
Vec3 gradient_balls(const std::vector<Ball>& balls, const Vec3& p);
Vec3 support_balls(const std::vector<Ball>& balls, const Vec3& direction);

double distance_box(const Vec3& half, const Vec3& p);
Vec3 gradient_box(const Vec3& half, const Vec3& p);
Vec3 support_box(const Vec3& half, const Vec3& direction);

}  // namespace ejecta
