#pragma once
#include "base/vec.hpp"

namespace ejecta {

struct Polytope;

/// gauge(p) <= 1 with gauge = (((|x|/a)^across + (|y|/b)^across)^(along/across) + (|z|/c)^along)^(1/along),
/// (a, b, c) = `half`: convex for exponents of 1 and more. Lengths in m, its own axes, origin in
/// its centre.
struct Superquadric {
  Vec3 half{1, 1, 1};
  double across = 2.0, along = 2.0;

  /// Homogeneous of degree one: p / gauge(p) lies on the surface.
  double gauge(const Vec3& p) const;
  /// The point farthest along `direction`, exact.
  Vec3 support(const Vec3& direction) const;
  /// Of the smallest sphere about the centre that holds it (Hoelder's inequality).
  double radius() const;
};

/// The part of a superquadric within `depth` (m) of the plane that touches it where it looks along `normal`
/// (unit), as a closed polytope whose facets grow with the part, so that they are as fine as the part is
/// small. For all of an ellipsoid the parts are one and the same but for an affine map, so what a part has
/// too little, 6 % of its volume, does not change as it rolls. Returns false, and does nothing, for what
/// reaches beyond three quarters of the way to the centre.
bool cut_cap(const Superquadric& solid, const Vec3& normal, double depth, Polytope& cap);

}  // namespace ejecta
