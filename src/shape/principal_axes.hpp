#pragma once
#include "shape/shape.hpp"

namespace ejecta {

/// Frame of the principal axes: the user's own where the products of inertia vanish (to 1e-9), otherwise the
/// eigenvectors, ordered and signed to lie as near to the user's axes as they can. `mass` is turned into it.
BodyFrame to_principal_axes(MassProperties& mass);
/// A point given in the user's axes, in body axes.
inline Vec3 to_body(const BodyFrame& frame, const Vec3& p) {
  return frame.rotation.conjugate() * (p - frame.centre);
}

}  // namespace ejecta
