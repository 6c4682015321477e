#include "dem/time_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace ejecta {

double rayleigh_time(double radius, double density, double youngs_modulus, double poisson_ratio) {
  const double shear = youngs_modulus / (2 * (1 + poisson_ratio));
  return std::numbers::pi * radius * std::sqrt(density / shear) / (0.1631 * poisson_ratio + 0.8766);
}

double contact_time(const Body& body, const Materials& materials, double velocity) {
  PairConstants<double> stiffest = materials.pair(body.material, body.material);
  for (int m = 0; m < materials.count(); ++m)
    stiffest.youngs = std::max(stiffest.youngs, materials.pair(body.material, m).youngs);
  const double mass = 0.5 * body.mass;  // of two such bodies, as half the radius
  const auto lasts = [&](double radius) {
    return with_law(materials.law(),
                    [&](auto law) { return law.contact_time(mass, 0.5 * radius, stiffest, velocity); });
  };
  if (!with_law(materials.law(), [](auto law) { return law.kIsElastic; }))
    return lasts(body.shape.bounding_radius());

  const MaterialSpec& m = materials.spec(body.material);
  double time = std::numeric_limits<double>::infinity();
  for (const Ball& ball : body.shape.balls()) {
    time = std::min(time, rayleigh_time(ball.radius, m.density, m.youngs_modulus, m.poisson_ratio));
    time = std::min(time, lasts(ball.radius));
  }
  if (!body.shape.polytopes().empty()) {
    const double size = std::cbrt(0.75 / std::numbers::pi * body.shape.mass_properties().volume);
    // Stiffness of a face of the area pi s^2 (narrow_phase.cpp), and more of a larger one, N/m
    double larger = 1.0;
    for (const Polytope& p : body.shape.polytopes())
      larger = std::max(larger, p.largest_face / (std::numbers::pi * size * size));
    const double face = 2 * (4.0 / 3.0) * stiffest.youngs * size / std::numbers::sqrt2 * larger;
    time = std::min({time, 0.5 * std::numbers::pi * std::sqrt(mass / face),
                     rayleigh_time(size, m.density, m.youngs_modulus, m.poisson_ratio)});
  }
  return time;
}

}  // namespace ejecta
