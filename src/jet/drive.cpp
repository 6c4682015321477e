#include "jet/drive.hpp"

#include "case/load.hpp"

namespace ejecta {
JetDrive::JetDrive(const Case& c)
    : valve_(c.valve, folder_of(c)),
      gas_{c.fluid.gamma, c.fluid.gas_constant},
      ambient_(c.environment.pressure),
      temperature_(c.valve.supply_temperature > 0.0 ? c.valve.supply_temperature : c.environment.temperature),
      intensity_(c.jet.turbulence_intensity) {
  valve_.require_jet(ambient_);
}

NozzleExit JetDrive::orifice(double time) const {
  return nozzle_exit(gas_, valve_.total_pressure(time, ambient_), temperature_, ambient_);
}

Supply JetDrive::supply(double time) const {
  return {valve_.total_pressure(time, ambient_), temperature_, intensity_ * orifice(time).velocity};
}

}  // namespace ejecta
