#pragma once
#include "base/vec.hpp"

namespace ejecta {

/// Of one piece of a turn that is integrated, rad.
inline constexpr double kLargestTurn = 0.05;

/// Turns `orientation` over dt under no torque, with the angular momentum `momentum` (world axes, kg m2/s)
/// held exactly. Splits the kinetic energy L1^2/2I1 + L2^2/2I2 + L3^2/2I3 into exact turns about single axes
/// (Dullweber, Leimkuhler & McLachlan 1997, J. Chem. Phys. 107:5840), composed to fourth order (Yoshida
/// 1990), in as many pieces as keep each turn below kLargestTurn: the energy error stays bounded.
void rotate_free(Quat& orientation, const Vec3& momentum, const Vec3& inertia, double dt);

/// All principal moments equal: spin and angular momentum are parallel.
inline bool is_round(const Vec3& inertia) { return inertia[0] == inertia[1] && inertia[1] == inertia[2]; }

/// A turn by the rotation vector (rad, world axes).
void turn(Quat& orientation, const Vec3& rotation);

/// Angular velocity (world, rad/s) of a body with this angular momentum.
inline Vec3 angular_velocity(const Quat& orientation, const Vec3& momentum, const Vec3& inertia) {
  if (is_round(inertia)) return momentum / inertia[0];
  return orientation * (orientation.conjugate() * momentum).cwiseQuotient(inertia);
}

}  // namespace ejecta
