#pragma once
#include <vector>

#include "base/vec.hpp"

/// Convex outlines as seen from above: corners counter-clockwise, z = 0. Lengths in m.
namespace ejecta {

/// The convex hull of points (Andrew 1979).
std::vector<Vec3> convex_outline(std::vector<Vec3> points);
double area_of_outline(const std::vector<Vec3>& outline);
double perimeter_of_outline(const std::vector<Vec3>& outline);
/// True where two outlines lie within `gap` of each other, or overlap.
bool within_gap(const std::vector<Vec3>& a, const std::vector<Vec3>& b, double gap);

}  // namespace ejecta
