#pragma once
#include <span>
#include <vector>

#include "case/case.hpp"
#include "sorter/feed_particle.hpp"

namespace ejecta {

/// A line camera above the belt: takes square pixels line by line, joins those nearer than the gap into
/// objects, and reads their mean signal.
class Camera {
 public:
  Camera(const Case& c);

  /// The objects of a stretch of belt, by their first line. Signals: of each particle, and the noise of
  /// pixels.
  std::vector<SeenObject> look(std::span<const FeedParticle> particles) const;
  double pixel() const { return pixel_; }  ///< m
  double threshold() const { return threshold_; }

 private:
  bool reads_eject(const SeenObject& object, std::span<const FeedParticle> particles) const;
  CameraSpec spec_;
  std::vector<ParticleClassSpec> classes_;
  std::int64_t seed_;
  double pixel_, half_width_, threshold_ = 0.0;
  bool eject_above_ = true, given_confusion_ = false;
};

}  // namespace ejecta
