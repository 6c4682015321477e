#include "jet/inflow.hpp"

#include <cmath>
#include <numbers>

#include "flow/turbulence/scales.hpp"

namespace ejecta {

SelfSimilarJet::SelfSimilarJet(const JetSpec& jet, const ValveSpec& valve, double discharge_coefficient)
    : nozzle_(jet.nozzle),
      diameter_(valve.orifice_diameter * std::sqrt(discharge_coefficient)),
      spread_((std::numbers::sqrt2 - 1.0) / (jet.spreading * jet.spreading)),
      decay_(jet.velocity_decay),
      origin_(jet.nozzle.z() + jet.virtual_origin * valve.orifice_diameter) {
  if (decay_ == 0.0) decay_ = 0.5 * std::sqrt(3.0 * spread_);
}

InflowState SelfSimilarJet::at(const Vec3& x, double equivalent_velocity) const {
  const double z = x.z() - origin_, dx = x.x() - nozzle_.x(), dy = x.y() - nozzle_.y();
  const double r = std::hypot(dx, dy), eta = r / z, centre = decay_ * equivalent_velocity * diameter_ / z;
  const double q = 1.0 + spread_ * eta * eta, shape = 1.0 / (q * q);
  const double radial = centre * (eta * shape - 0.5 * eta / q);
  InflowState s;
  s.velocity = Vec3(r > 0.0 ? radial * dx / r : 0.0, r > 0.0 ? radial * dy / r : 0.0, centre * shape);
  s.k = 0.07 * centre * centre * shape;
  const double eddy_viscosity = centre * z / (8.0 * spread_);
  s.epsilon = eddy_viscosity > 0.0 ? epsilon_with(s.k, eddy_viscosity) : 0.0;
  return s;
}

NozzleInflow::NozzleInflow(const JetSpec& jet, const ValveSpec& valve)
    : nozzle_(jet.nozzle),
      radius_(0.5 * valve.orifice_diameter * std::sqrt(valve.discharge_coefficient)),
      intensity_(jet.turbulence_intensity) {}

InflowState NozzleInflow::at(double share, double velocity) const {
  InflowState s;
  s.velocity = Vec3(0, 0, share * velocity);
  s.k = 1.5 * std::pow(intensity_ * velocity, 2);
  s.epsilon = epsilon_of_pipe(s.k, 2.0 * radius_);
  return s;
}

double NozzleInflow::share(const Vec3& centre, double half_x, double half_y) const {
  constexpr int n = 16;
  int inside = 0;
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < n; ++b) {
      const double x = centre.x() - nozzle_.x() + half_x * ((2 * a + 1.0) / n - 1.0);
      const double y = centre.y() - nozzle_.y() + half_y * ((2 * b + 1.0) / n - 1.0);
      inside += x * x + y * y < radius_ * radius_;
    }
  return double(inside) / (n * n);
}

}  // namespace ejecta
