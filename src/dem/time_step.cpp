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

double hertz_time(double mass, double radius, double youngs, double velocity) {
  const double depth = std::pow(15 * mass * velocity * velocity / (16 * youngs * std::sqrt(radius)), 0.4);
  return 2.9432 * depth / velocity;
}

double contact_time(const Body& body, const Materials& materials, double velocity) {
  double youngs = 0.0;
  for (int m = 0; m < materials.count(); ++m)
    youngs = std::max(youngs, materials.pair(body.material, m).youngs);
  const bool linear = materials.law() == ContactLaw::linear;
  // Two such bodies: half the mass and half the radius.
  const double mass = 0.5 * body.mass, stiffness = materials.pair(body.material, body.material).stiffness;
  if (linear) return std::numbers::pi * std::sqrt(mass / stiffness);

  const MaterialSpec& m = materials.spec(body.material);
  double time = std::numeric_limits<double>::infinity();
  for (const Ball& ball : body.shape.balls()) {
    time = std::min(time, rayleigh_time(ball.radius, m.density, m.youngs_modulus, m.poisson_ratio));
    time = std::min(time, hertz_time(mass, 0.5 * ball.radius, youngs, velocity));
  }
  if (!body.shape.polytopes().empty()) {
    const double size = std::cbrt(0.75 / std::numbers::pi * body.shape.mass_properties().volume);
    const double face = 2 * (4.0 / 3.0) * youngs * size / std::numbers::sqrt2;  // N/m, narrow_phase.cpp
    time = std::min({time, 0.5 * std::numbers::pi * std::sqrt(mass / face),
                     rayleigh_time(size, m.density, m.youngs_modulus, m.poisson_ratio)});
  }
  return time;
}

}  // namespace ejecta
