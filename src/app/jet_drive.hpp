#pragma once
#include <vector>

#include "case/case.hpp"
#include "flow/godunov/from_case.hpp"
#include "sorter/nozzle.hpp"
#include "sorter/valve.hpp"

namespace ejecta {

/// The valve at work on the orifices of a compressible flow: total pressure and temperature, and the
/// turbulence that enters.
class JetDrive {
 public:
  /// Throws InputError when the supply cannot blow against the ambient pressure.
  explicit JetDrive(const Case& c);
  void apply(double time, godunov::GasFlow& flow, const std::vector<godunov::DrivenInlet>& inlets) const;
  /// Exact one-dimensional state of the orifice at `time`.
  NozzleExit exit(double time) const;
  const Valve& valve() const { return valve_; }

 private:
  Valve valve_;
  Gas gas_;
  double ambient_, temperature_, intensity_;
  bool omega_;
};

}  // namespace ejecta
