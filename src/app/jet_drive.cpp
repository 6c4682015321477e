#include "app/jet_drive.hpp"

#include <cmath>

#include "case/load.hpp"

namespace ejecta {
namespace {

/// Dissipation of the turbulence that enters: mixing length 0.07 d of a pipe (Versteeg & Malalasekera,
/// section 3.7.2), epsilon = C_mu^(3/4) k^(3/2) / l
double inlet_epsilon(double k, double diameter) {
  return std::pow(0.09, 0.75) * std::pow(k, 1.5) / (0.07 * diameter);
}

}  // namespace

JetDrive::JetDrive(const Case& c)
    : valve_(c.valve, folder_of(c)),
      gas_{c.fluid.gamma, c.fluid.gas_constant},
      ambient_(c.environment.pressure),
      temperature_(c.valve.supply_temperature > 0.0 ? c.valve.supply_temperature : c.environment.temperature),
      intensity_(c.jet.turbulence_intensity),
      omega_(c.flow.turbulence == TurbulenceModel::k_omega_sst) {
  valve_.require_jet(ambient_);
}

NozzleExit JetDrive::exit(double time) const {
  return nozzle_exit(gas_, valve_.total_pressure(time, ambient_), temperature_, ambient_);
}

void JetDrive::apply(double time, godunov::GasFlow& flow,
                     const std::vector<godunov::DrivenInlet>& inlets) const {
  const double fluctuation = intensity_ * exit(time).velocity;
  for (const godunov::DrivenInlet& inlet : inlets) {
    godunov::Condition& condition = flow.boundaries().condition(inlet.handle);
    condition.total_pressure = valve_.total_pressure(time, ambient_);
    condition.total_temperature = temperature_;
    if (fluctuation <= 0.0) continue;
    condition.state.k = 1.5 * fluctuation * fluctuation;
    condition.state.e = inlet_epsilon(condition.state.k, 2.0 * inlet.radius);
    if (omega_) condition.state.e = godunov::omega_of(condition.state.k, condition.state.e);
  }
}

}  // namespace ejecta
