#include "sorter/air_vessel.hpp"

#include <algorithm>
#include <cmath>

#include "jet/nozzle.hpp"

namespace ejecta {
namespace {

constexpr double kVesselStep = 0.5e-3;  ///< s: short beside any command

}  // namespace

AirVessel::AirVessel(const Case& c) : case_(c) {}

void AirVessel::draw(std::vector<std::vector<ValvePulse>>& pulses) const {
  if (!(case_.manifold.vessel > 0.0)) return;
  double first = 1e300, last = -1e300;
  for (const auto& list : pulses)
    for (const ValvePulse& p : list) {
      first = std::min(first, p.from);
      last = std::max(last, p.to);
    }
  if (first > last) return;
  const auto steps = static_cast<std::size_t>((last - first) / kVesselStep) + 1;
  std::vector<int> opens(steps + 1, 0);  // valves that open less those that close, in each step
  const auto step_of = [&](double t) { return static_cast<std::size_t>((t - first) / kVesselStep); };
  for (const auto& list : pulses)
    for (const ValvePulse& p : list) {
      ++opens[step_of(p.from)];
      --opens[std::min(step_of(p.to), steps)];
    }
  const Gas gas{case_.fluid.gamma, case_.fluid.gas_constant};
  const double ambient = case_.environment.pressure, full = case_.valve.supply_pressure,
               temperature = case_.valve.supply_temperature > 0.0 ? case_.valve.supply_temperature
                                                                  : case_.environment.temperature;
  const auto valve = [&](double p) { return nozzle_exit(gas, p, temperature, ambient); };
  const double line = nozzle_area(case_.manifold.line_diameter),
               rate = gas.gas_constant * temperature / case_.manifold.vessel,
               thrust = valve(full).thrust_per_area;
  // Sums over time of the thrust and of the pressure, over those of the full vessel.
  std::vector<double> strength(steps + 1, 0.0), use(steps + 1, 0.0);
  double pressure = full;
  int open = 0;
  for (std::size_t n = 0; n < steps; ++n) {
    open += opens[n];
    const double taken = open * nozzle_mass_flow(valve(pressure), case_.valve.discharge_coefficient,
                                                 case_.valve.orifice_diameter),
                 brought = line * nozzle_exit(gas, full, temperature, pressure).mass_flux;
    pressure = std::clamp(pressure + kVesselStep * rate * (brought - taken), ambient, full);
    strength[n + 1] = strength[n] + valve(pressure).thrust_per_area / thrust;
    use[n + 1] = use[n] + pressure / full;
  }
  for (auto& list : pulses)
    for (ValvePulse& p : list) {
      const std::size_t a = step_of(p.from), b = std::clamp(step_of(p.to), a + 1, steps);
      p.strength = (strength[b] - strength[a]) / static_cast<double>(b - a);
      p.use = (use[b] - use[a]) / static_cast<double>(b - a);
    }
}

}  // namespace ejecta
