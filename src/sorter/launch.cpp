#include "sorter/launch.hpp"

namespace ejecta {

FlightState launch_state(const LaunchSpec& l, const Vec3& nozzle, const Vec3& gravity, double time) {
  const double fall = l.drop_distance / l.belt_speed;  // time from the belt to the jet
  const double since = time - l.arrives_at;
  const Vec3 at_jet = nozzle + Vec3(l.offset_along, l.offset_across, l.stand_off);
  const Vec3 velocity = Vec3(l.belt_speed, 0, 0) + fall * gravity;
  return {at_jet + since * velocity + 0.5 * since * since * gravity, velocity + since * gravity};
}

double launch_height_at(const LaunchSpec& l, const Vec3& nozzle, const Vec3& gravity, double x) {
  const double since = (x - nozzle.x() - l.offset_along) / l.belt_speed;
  return launch_state(l, nozzle, gravity, l.arrives_at + since).position.z();
}

}  // namespace ejecta
