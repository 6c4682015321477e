#pragma once
#include <vector>

#include "case/case.hpp"
#include "sorter/feed_particle.hpp"

namespace ejecta {

/// The vessel that all valves draw from and the line that fills it again: many open valves lower the pressure
/// of all. Isothermal: dp/dt = R T/V (what the line brings - what open valves take); both by the exact
/// relations of a nozzle.
class AirVessel {
 public:
  explicit AirVessel(const Case& c);
  /// Sets the strength and the use of each pulse. The vessel is full ahead of the first.
  void draw(std::vector<std::vector<ValvePulse>>& pulses) const;

 private:
  Case case_;
};

}  // namespace ejecta
