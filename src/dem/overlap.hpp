#pragma once
#include <span>

#include "shape/polytope.hpp"

namespace ejecta {

/// The region two solids share. Axes are those of the first one, a.
struct Overlap {
  double volume = 0.0;     ///< m3
  Vec3 centroid{0, 0, 0};  ///< m
  Vec3 area{0, 0, 0};      ///< m2, vector area of b's surface inside a; its direction pushes a out of b
  Vec3 middle{0, 0, 0};    ///< m, centroid of that surface; of a cell, of its first plane inside a
  double depth = 0.0;      ///< m, of the centroid below the plane or the first plane of a cell
  double first = 0.0;      ///< m2, of the first plane of a cell inside a
};

/// Of a polytope with the half-space normal . x < offset.
Overlap overlap_half_space(const Polytope& a, const Vec3& normal, double offset);

/// Of a polytope with all that lies within the planes; `area` is that of all of them inside a.
Overlap overlap_cell(const Polytope& a, std::span<const HalfSpace> planes);

/// Whether a plane keeps two polytopes apart by more than what rounding may hide; false: not found. `along`:
/// its normal, from a to b, as it was (zero: unknown) and is: from step to step it hardly turns.
bool stand_apart(const Polytope& a, const Polytope& b, const Mat3& rotation, const Vec3& translation,
                 Vec3& along);

/// Of two polytopes; p -> rotation * p + translation takes b's axes to a's.
Overlap overlap_polytopes(const Polytope& a, const Polytope& b, const Mat3& rotation,
                          const Vec3& translation);

}  // namespace ejecta
