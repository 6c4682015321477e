#pragma once
#include <cmath>
#include <numbers>

#include "flow/ideal_gas.hpp"

/// Convergent nozzle of a valve: isentropic up to the orifice, choked when p0/pa exceeds the critical ratio.
/// Pure functions in SI units. Source: Anderson, Modern Compressible Flow, 3rd ed., chapter 5.
namespace ejecta {

/// One-dimensional state in the plane of the orifice.
struct NozzleExit {
  double mach = 0.0;
  double pressure = 0.0;         ///< Pa absolute
  double temperature = 0.0;      ///< K
  double density = 0.0;          ///< kg/m3
  double velocity = 0.0;         ///< m/s
  double mass_flux = 0.0;        ///< kg/m2/s
  double thrust_per_area = 0.0;  ///< Pa: rho u^2 + (p - pa)
};

/// State in the orifice of a nozzle of total pressure p0 (Pa absolute) and temperature T0 (K) blowing into
/// the ambient pressure pa. Choked: Mach 1 and p* = p0 (2/(g+1))^(g/(g-1)), so that the mass flux is p0
/// sqrt(g/(R T0)) (2/(g+1))^((g+1)/(2(g-1))) and the thrust (g+1) p* - pa. Below choking: p = pa. No flow
/// when p0 <= pa.
inline NozzleExit nozzle_exit(const Gas& gas, double total_pressure, double total_temperature,
                              double ambient_pressure) {
  const double ratio = total_pressure / ambient_pressure;
  const double mach = ratio <= 1.0                                ? 0.0
                      : ratio >= gas_critical_pressure_ratio(gas) ? 1.0
                                                                  : gas_isentropic_mach(gas, ratio);
  NozzleExit e;
  e.mach = mach;
  e.pressure = mach == 1.0 ? total_pressure / gas_critical_pressure_ratio(gas) : ambient_pressure;
  e.temperature = total_temperature / gas_total_temperature_ratio(gas, mach);
  e.density = gas_density(gas, e.pressure, e.temperature);
  e.velocity = mach * gas_sound_speed(gas, e.temperature);
  e.mass_flux = e.density * e.velocity;
  e.thrust_per_area = e.mass_flux * e.velocity + (e.pressure - ambient_pressure);
  return e;
}

/// m2
inline double nozzle_area(double diameter) { return 0.25 * std::numbers::pi * diameter * diameter; }

/// Velocity of an incompressible jet of ambient density that leaves the whole orifice with the same momentum:
/// U_eq = sqrt(C_D F / (A rho_a)), m/s; choked F/A = (g+1) p* - pa.
inline double nozzle_equivalent_velocity(const NozzleExit& exit, double discharge_coefficient,
                                         double ambient_density) {
  return std::sqrt(discharge_coefficient * exit.thrust_per_area / ambient_density);
}

/// kg/s through an orifice of `diameter`; C_D is the share of the area that flows
inline double nozzle_mass_flow(const NozzleExit& exit, double discharge_coefficient, double diameter) {
  return discharge_coefficient * nozzle_area(diameter) * exit.mass_flux;
}

/// N
inline double nozzle_thrust(const NozzleExit& exit, double discharge_coefficient, double diameter) {
  return discharge_coefficient * nozzle_area(diameter) * exit.thrust_per_area;
}

/// Litres of a mass of gas (kg) at 0 C and 101325 Pa
inline double nozzle_normal_litres(const Gas& gas, double mass) {
  return 1e3 * mass / gas_density(gas, 101325.0, 273.15);
}

/// Distance of the Mach disk from the orifice, m: x_M = 0.67 D sqrt(p0/pa) (Ashkenas & Sherman 1966). The
/// disk appears above p0/pa of about 4.
inline double nozzle_mach_disk(double total_pressure, double ambient_pressure, double diameter) {
  return 0.67 * diameter * std::sqrt(total_pressure / ambient_pressure);
}

/// Length of the first shock cell, m: L = 1.3064 D_j sqrt(M_j^2 - 1) (Prandtl 1904, Pack 1950), with M_j and
/// D_j of the jet expanded to the ambient pressure; 0 when the nozzle is not under-expanded.
inline double nozzle_shock_cell(const Gas& gas, double total_pressure, double ambient_pressure,
                                double diameter) {
  const double mach = gas_isentropic_mach(gas, total_pressure / ambient_pressure);
  if (!(mach > 1.0)) return 0.0;
  const double g = gas.gamma;
  const double area_ratio =
      std::pow(2.0 / (g + 1.0) * gas_total_temperature_ratio(gas, mach), 0.5 * (g + 1.0) / (g - 1.0)) / mach;
  return 1.3064 * diameter * std::sqrt(area_ratio * (mach * mach - 1.0));
}

/// Least work to compress a mass of gas (kg) from pa to p0 at the temperature T, J: m R T ln(p0/pa)
inline double nozzle_isothermal_work(const Gas& gas, double mass, double temperature, double total_pressure,
                                     double ambient_pressure) {
  return mass * gas.gas_constant * temperature * std::log(total_pressure / ambient_pressure);
}

}  // namespace ejecta
