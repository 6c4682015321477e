#pragma once
#include <memory>
#include <vector>

#include "case/case.hpp"
#include "case/size_distribution.hpp"
#include "dem/body.hpp"
#include "sorter/feed_particle.hpp"

namespace ejecta {

/// A [[sorter.class]] made ready to draw particles from.
class ParticleClass {
 public:
  /// `directory`: where relative file names start. Throws InputError for files it cannot use.
  ParticleClass(const ParticleClassSpec& spec, const std::string& directory, std::int64_t seed);

  /// Of the share `u` (0 to 1) of the particles, by number, that are smaller; m.
  double size_at(double u) const { return sizes_.quantile(u); }
  /// One of the prototypes, by a number 0 to 1.
  const Prototype& prototype(double u) const;
  double mass_of(const Prototype& p, double scale) const {
    return spec_.density * p.volume * scale * scale * scale;
  }

  const std::vector<Prototype>& prototypes() const { return prototypes_; }

  double mean_mass() const { return mean_mass_; }            ///< kg, of a particle
  double mean_area() const { return mean_area_; }            ///< m2, of outlines from above
  double mean_perimeter() const { return mean_perimeter_; }  ///< m
  const ParticleClassSpec& spec() const { return spec_; }

 private:
  ParticleClassSpec spec_;
  SizeDistribution sizes_;
  std::vector<Prototype> prototypes_;
  double mean_mass_ = 0.0, mean_area_ = 0.0, mean_perimeter_ = 0.0;
};

/// Sub-steps of contacts on the sorter are this part of the contact time. Longer than a run's tenth: an
/// impact errs by 2 % of its energy, of which surfaces take nine tenths anyway.
inline constexpr double kSorterStepFraction = 0.25;

/// A particle of that class as a body of the first material, at rest at the origin, turned as it lies on the
/// belt.
Body body_of(const FeedParticle& p, const ParticleClassSpec& kind);

}  // namespace ejecta
