#include "sorter/air_vessel.hpp"

#include <algorithm>
#include <cmath>

#include "jet/nozzle.hpp"

namespace ejecta {
namespace {

constexpr double kVesselStep = 0.5e-3;  ///< s: short beside any command

double supply_temperature(const Case& c) {
  return c.valve.supply_temperature > 0.0 ? c.valve.supply_temperature : c.environment.temperature;
}

}  // namespace

AirVessel::AirVessel(const Case& c) : case_(c) {}

/// visit(step, pressure) after every step of time.
template <class Visit>
double AirVessel::march(const ValvePulses& pulses, double from, double until, double pressure,
                        const Visit& visit) const {
  const auto steps = static_cast<std::size_t>(std::max(0.0, std::ceil((until - from) / kVesselStep)));
  std::vector<int> opens(steps + 1, 0);  // valves that open less those that close, in each step
  const auto step_of = [&](double t) {
    return static_cast<std::size_t>(std::clamp((t - from) / kVesselStep, 0.0, static_cast<double>(steps)));
  };
  for (const auto& list : pulses)
    for (const ValvePulse& p : list) {
      ++opens[step_of(p.from)];
      --opens[step_of(p.to)];
    }
  const Gas gas{case_.fluid.gamma, case_.fluid.gas_constant};
  const double ambient = case_.environment.pressure, temperature = supply_temperature(case_),
               line = nozzle_area(case_.manifold.line_diameter),
               rate = gas.gas_constant * temperature / case_.manifold.vessel;
  int open = 0;
  for (std::size_t n = 0; n < steps; ++n) {
    open += opens[n];
    const double dt = std::min(kVesselStep, until - from - static_cast<double>(n) * kVesselStep);
    const double taken =
                     open * nozzle_mass_flow(nozzle_exit(gas, pressure, temperature, ambient),
                                             case_.valve.discharge_coefficient, case_.valve.orifice_diameter),
                 brought = line * nozzle_exit(gas, full(), temperature, pressure).mass_flux;
    pressure = std::clamp(pressure + dt * rate * (brought - taken), ambient, full());
    visit(n, pressure);
  }
  return pressure;
}

double AirVessel::after(const ValvePulses& pulses, double from, double until, double pressure) const {
  return march(pulses, from, until, pressure, [](std::size_t, double) {});
}

void AirVessel::draw(ValvePulses& pulses, double from, double pressure) const {
  double last = from;
  for (const auto& list : pulses)
    for (const ValvePulse& p : list) last = std::max(last, p.to);
  const Gas gas{case_.fluid.gamma, case_.fluid.gas_constant};
  const auto thrust = [&](double p) {
    return nozzle_exit(gas, p, supply_temperature(case_), case_.environment.pressure).thrust_per_area;
  };
  // Sums over time of the thrust and of the pressure, over those of the full vessel.
  std::vector<double> strength{0.0}, use{0.0};
  const double full_thrust = thrust(full());
  march(pulses, from, last, pressure, [&](std::size_t, double p) {
    strength.push_back(strength.back() + thrust(p) / full_thrust);
    use.push_back(use.back() + p / full());
  });
  const std::size_t steps = strength.size() - 1;
  if (steps == 0) return;
  const auto step_of = [&](double t) {
    return std::min(static_cast<std::size_t>(std::max(0.0, (t - from) / kVesselStep)), steps);
  };
  for (auto& list : pulses)
    for (ValvePulse& p : list) {
      const std::size_t a = std::min(step_of(p.from), steps - 1), b = std::clamp(step_of(p.to), a + 1, steps);
      p.strength = (strength[b] - strength[a]) / static_cast<double>(b - a);
      p.use = (use[b] - use[a]) / static_cast<double>(b - a);
    }
}

}  // namespace ejecta
