#pragma once
#include <cmath>

/// The ideal gas with constant heats, as pure functions of plain values in SI units. Sources: Anderson,
/// Modern Compressible Flow, 3rd ed., chapters 3 and 5.
namespace ejecta {

/// Ratio of specific heats and specific gas constant, J/kg/K.
struct Gas {
  double gamma = 1.4;
  double gas_constant = 287.05;

  double specific_heat_pressure() const { return gamma * gas_constant / (gamma - 1.0); }  ///< J/kg/K
};

/// kg/m3, from p = rho R T
inline double gas_density(const Gas& gas, double pressure, double temperature) {
  return pressure / (gas.gas_constant * temperature);
}

/// a = sqrt(gamma R T), m/s
inline double gas_sound_speed(const Gas& gas, double temperature) {
  return std::sqrt(gas.gamma * gas.gas_constant * temperature);
}

/// T0/T = 1 + (gamma - 1)/2 M^2
inline double gas_total_temperature_ratio(const Gas& gas, double mach) {
  return 1.0 + 0.5 * (gas.gamma - 1.0) * mach * mach;
}

/// p0/p = (T0/T)^(gamma/(gamma - 1)), isentropic
inline double gas_total_pressure_ratio(const Gas& gas, double mach) {
  return std::pow(gas_total_temperature_ratio(gas, mach), gas.gamma / (gas.gamma - 1.0));
}

/// Mach number at which isentropic flow of total pressure p0 reaches the pressure p <= p0
inline double gas_isentropic_mach(const Gas& gas, double total_over_static) {
  const double t = std::pow(total_over_static, (gas.gamma - 1.0) / gas.gamma);
  return std::sqrt(std::fmax(0.0, 2.0 / (gas.gamma - 1.0) * (t - 1.0)));
}

/// p0/p above which a convergent nozzle is choked: ((gamma + 1)/2)^(gamma/(gamma - 1))
inline double gas_critical_pressure_ratio(const Gas& gas) {
  return std::pow(0.5 * (gas.gamma + 1.0), gas.gamma / (gas.gamma - 1.0));
}

/// What a Pitot tube reads over the static pressure: isentropic below Mach 1, behind a normal shock above
/// (Rayleigh's Pitot formula)
inline double gas_pitot_ratio(const Gas& gas, double mach) {
  if (mach <= 1.0) return gas_total_pressure_ratio(gas, mach);
  const double g = gas.gamma, m2 = mach * mach;
  return std::pow(0.5 * (g + 1.0) * m2, g / (g - 1.0)) *
         std::pow((g + 1.0) / (2.0 * g * m2 - (g - 1.0)), 1.0 / (g - 1.0));
}

/// p2/p1 across a normal shock
inline double gas_normal_shock_ratio(const Gas& gas, double mach) {
  return 1.0 + 2.0 * gas.gamma / (gas.gamma + 1.0) * (mach * mach - 1.0);
}

}  // namespace ejecta
