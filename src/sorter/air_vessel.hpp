#pragma once
#include <vector>

#include "case/case.hpp"
#include "sorter/feed_particle.hpp"

namespace ejecta {

/// The vessel that all valves draw from and the line that fills it again: many open valves lower the pressure
/// of all. Isothermal: dp/dt = R T/V (what the line brings - what open valves take); both by the exact
/// relations of a nozzle. Pressures in Pa, times in s.
class AirVessel {
 public:
  explicit AirVessel(const Case& c);
  bool is_there() const { return case_.manifold.vessel > 0.0; }
  double full() const { return case_.valve.supply_pressure; }
  /// The pressure at `until` of what has `pressure` at `from`.
  double after(const ValvePulses& pulses, double from, double until, double pressure) const;
  /// Sets the strength and the use of each pulse, of what has `pressure` at `from`.
  void draw(ValvePulses& pulses, double from, double pressure) const;

 private:
  template <class Visit>
  double march(const ValvePulses& pulses, double from, double until, double pressure,
               const Visit& visit) const;
  Case case_;
};

}  // namespace ejecta
