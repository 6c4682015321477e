#include "sorter/air_use.hpp"

#include <algorithm>

#include "jet/drive.hpp"
#include "jet/nozzle.hpp"

namespace ejecta {
namespace {

constexpr double kCommandStep = 0.5e-3, kLongestCommand = 60e-3, kStep = 2e-5;  // s

double mass_of_command(Case c, double lasts) {
  c.valve.opens_at = 0.0;
  c.valve.more_pulses.clear();
  c.valve.duration = lasts;
  const JetDrive drive(c);
  double sum = 0.0;
  for (double t = 0.5 * kStep; t < drive.valve().closed_from(); t += kStep)
    sum +=
        kStep * nozzle_mass_flow(drive.orifice(t), c.valve.discharge_coefficient, c.valve.orifice_diameter);
  return sum;
}

}  // namespace

AirUse::AirUse(const Case& c) : case_(c) {
  mass_.push_back(0.0);
  for (double lasts = kCommandStep; lasts < kLongestCommand; lasts += kCommandStep)
    mass_.push_back(mass_of_command(c, lasts));
}

double AirUse::mass(double lasts) const {
  // Beyond the table the valve is open and the flow steady.
  const double at = lasts / kCommandStep;
  const auto n = std::min(static_cast<std::size_t>(at), mass_.size() - 2);
  return mass_[n] + (at - static_cast<double>(n)) * (mass_[n + 1] - mass_[n]);
}

double AirUse::normal_m3(double mass) const {
  const Gas gas{case_.fluid.gamma, case_.fluid.gas_constant};
  return 1e-3 * nozzle_normal_litres(gas, mass);
}

double AirUse::least_work(double mass) const {
  const Gas gas{case_.fluid.gamma, case_.fluid.gas_constant};
  return nozzle_isothermal_work(gas, mass, case_.environment.temperature, case_.valve.supply_pressure,
                                case_.environment.pressure);
}

}  // namespace ejecta
