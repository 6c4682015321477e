#pragma once
#include "case/case.hpp"
#include "flow/model/inflow.hpp"
#include "jet/nozzle.hpp"
#include "jet/valve.hpp"

namespace ejecta {

/// The valve at work on the orifices of a gas: total pressure and temperature, and the turbulence that
/// enters.
class JetDrive {
 public:
  /// Throws InputError when the supply cannot blow against the ambient pressure.
  explicit JetDrive(const Case& c);
  Supply supply(double time) const;
  /// Exact one-dimensional state of the orifice at `time`.
  NozzleExit orifice(double time) const;
  const Valve& valve() const { return valve_; }

 private:
  Valve valve_;
  Gas gas_;
  double ambient_, temperature_, intensity_;
};

}  // namespace ejecta
