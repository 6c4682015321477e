#pragma once
#include <vector>

#include "case/case.hpp"
#include "sorter/feed_particle.hpp"
#include "sorter/particle_class.hpp"

namespace ejecta {

/// From the tray of a feeder to the camera, contacts computed (src/dem): particles ride over the lip, fall on
/// the running belt, bounce, slip and tumble until they rest on it. The belt has skirts at both sides.
class Feeder {
 public:
  Feeder(const Case& c, const std::vector<ParticleClass>& classes);

  /// `tray`: how they lie on it, x (m) from the lip against the motion: at time x / lip_speed the centre is
  /// above the lip. Returns them in the same order: x and y as they lie when the camera sees them, x from the
  /// place that one has which slips to rest and never bounces; as they lie (`tilt`), and what they still do
  /// then (`late`, `beside`, `turned`, `spin`). Throws InputError for one that does not come.
  /// Nobody waits for those after `wanted`: they are only there to be touched, and are returned as they came.
  std::vector<FeedParticle> run(std::vector<FeedParticle> tray, std::size_t wanted) const;

  /// s, from the lip to the camera, of a particle that falls, lands without a bounce and slips to rest.
  double delay() const { return delay_; }
  double early() const;                 ///< s: nobody comes sooner than after `delay` by more
  static constexpr double kLate = 0.7;  ///< s: who is later by more is said to come never

 private:
  struct Scene;
  ContactSpec contacts() const;

  Case case_;
  const std::vector<ParticleClass>* classes_;
  double camera_x_, end_x_, largest_, step_ = 0.0, delay_;
};

/// s, of a fall from the lip to the belt.
double fall_time(const Case& c);

}  // namespace ejecta
