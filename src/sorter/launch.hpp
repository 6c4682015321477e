#pragma once
#include <span>
#include <vector>

#include "case/case.hpp"
#include "dem/body.hpp"

namespace ejecta {

/// Place and velocity of a body's centre.
struct FlightState {
  Vec3 position{0, 0, 0};  ///< m
  Vec3 velocity{0, 0, 0};  ///< m/s
};

/// Where a body lies on the belt beside the place that [launch] gives, m. What lies ahead arrives sooner, on
/// the same path.
struct BeltPlace {
  double along = 0.0, across = 0.0;
};

/// The free flight from the belt (paper 2.2.5), no air: the body leaves the belt horizontally and crosses
/// x = nozzle.x + offset_along at `arrives_at`, `stand_off` above the nozzle.
FlightState launch_state(const LaunchSpec& launch, const Vec3& nozzle, const Vec3& gravity, double time,
                         const BeltPlace& place = {});

/// Height of the undisturbed path above x, m (of the world).
double launch_height_at(const LaunchSpec& launch, const Vec3& nozzle, const Vec3& gravity, double x);

/// Of each body of the case, in its order and with their shapes: by [launch] and its own place on the belt,
/// or as the case places it. At t = 0 and, for what is released later, at its release.
std::vector<FlightState> flight_starts(const Case& c, std::span<const Body> bodies);

/// The centre of a body that nothing touches, t (s) later.
inline Vec3 free_flight(const FlightState& start, const Vec3& gravity, double t) {
  return start.position + t * start.velocity + 0.5 * t * t * gravity;
}

}  // namespace ejecta
