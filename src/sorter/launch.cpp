#include "sorter/launch.hpp"

#include <algorithm>

namespace ejecta {
namespace {

/// From the centre to the foremost (+1) or hindmost (-1) point along x, m.
double reach_along(const Body& b, double sign) {
  const Vec3 direction = b.orientation.conjugate() * Vec3(sign, 0, 0);
  return direction.dot(b.shape.support(direction));
}

/// Behind another body: its place less the two halves and the gap between them.
double along_belt(const Case& c, std::span<const Body> bodies, std::size_t n) {
  const BodySpec& b = c.bodies[n];
  if (b.behind.empty()) return b.along;
  const auto ahead = std::find_if(c.bodies.begin(), c.bodies.end(),
                                  [&](const BodySpec& other) { return other.name == b.behind; });
  const auto m = static_cast<std::size_t>(ahead - c.bodies.begin());
  return along_belt(c, bodies, m) - reach_along(bodies[m], -1.0) - b.gap - reach_along(bodies[n], 1.0);
}

}  // namespace

FlightState launch_state(const LaunchSpec& l, const Vec3& nozzle, const Vec3& gravity, double time,
                         const BeltPlace& place) {
  const double fall = l.drop_distance / l.belt_speed;  // time from the belt to the jet
  const double since = time - l.arrives_at + place.along / l.belt_speed;
  const Vec3 at_jet = nozzle + Vec3(l.offset_along, l.offset_across + place.across, l.stand_off);
  const Vec3 velocity = Vec3(l.belt_speed, 0, 0) + fall * gravity;
  return {at_jet + since * velocity + 0.5 * since * since * gravity, velocity + since * gravity};
}

double launch_height_at(const LaunchSpec& l, const Vec3& nozzle, const Vec3& gravity, double x) {
  const double since = (x - nozzle.x() - l.offset_along) / l.belt_speed;
  return launch_state(l, nozzle, gravity, l.arrives_at + since).position.z();
}

std::vector<FlightState> flight_starts(const Case& c, std::span<const Body> bodies) {
  std::vector<FlightState> starts;
  for (std::size_t n = 0; n < bodies.size(); ++n) {
    if (c.launch.enabled && c.bodies[n].on_belt)
      starts.push_back(launch_state(c.launch, c.jet.nozzle, c.environment.gravity, 0.0,
                                    {along_belt(c, bodies, n), c.bodies[n].across}));
    else
      starts.push_back(
          {bodies[n].position, bodies[n].motion == Motion::free ? c.bodies[n].velocity : bodies[n].velocity});
  }
  return starts;
}

}  // namespace ejecta
