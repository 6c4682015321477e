#pragma once
#include "case/case.hpp"

namespace ejecta {

/// Place and velocity of a body's centre.
struct FlightState {
  Vec3 position{0, 0, 0};  ///< m
  Vec3 velocity{0, 0, 0};  ///< m/s
};

/// The free flight from the belt (paper 2.2.5), no air: the body leaves the belt horizontally and crosses
/// x = nozzle.x + offset_along at `arrives_at`, `stand_off` above the nozzle.
FlightState launch_state(const LaunchSpec& launch, const Vec3& nozzle, const Vec3& gravity, double time);

/// Height of the undisturbed path above x, m (of the world).
double launch_height_at(const LaunchSpec& launch, const Vec3& nozzle, const Vec3& gravity, double x);

}  // namespace ejecta
