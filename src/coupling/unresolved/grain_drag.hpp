#pragma once
#include <array>

#include "coupling/unresolved/drag_law.hpp"

/// The drag on grains over a flow step, on several at once.
namespace ejecta::drag {

/// What is the same for all grains in a step.
struct Step {
  double dt = 0;     ///< s
  double wakes = 0;  ///< 1: grains see what they move of the fluid themselves
};

/// Grains whose drag is found together: a whole number of registers.
struct Batch {
  static constexpr int kSize = 16;
  using Numbers = double[kSize];
  Numbers diameter, volume, mass;    ///< m, m3, kg
  Numbers is_free;                   ///< 1; 0: its velocity is given
  Numbers fraction;                  ///< of the fluid around it
  Numbers fluid_density, viscosity;  ///< kg/m3, m2/s, kinematic
  Numbers density, spread;           ///< of what it leaves in cells, 1/m3, m (own_wake.hpp)
  Numbers slip[3], acceleration[3];  ///< seen less own velocity, m/s; by all but drag, m/s2
  Numbers coefficient, reynolds;     ///< results: beta of the step, kg/s; at its beginning
  Numbers gain[3];                   ///< result, m/s: what of `acceleration` the drag meets
  /// The last of `count` grains stands for those that are not there.
  void fill_up(std::size_t count);
};

/// Fills the results of a batch. m dv/dt = m a + beta (u - v) over dt with beta held: its mean drag is
/// (m/dt) (1 - exp(-x)) (u - v - lag(x) dt a), x = beta dt / m.
template <double (*law)(const Surroundings&)>
void find_drag(const Step& step, Batch& b);

/// A law, and up to where it was fitted or derived.
struct Law {
  double (*beta)(const Surroundings&) = nullptr;
  void (*find)(const Step&, Batch&) = nullptr;  ///< nothing: no drag
  double most_reynolds = 1e300, least_fraction = 0.0;
};
/// In the order of the words of the case file (GrainDragLaw).
extern const std::array<Law, 7> kLaws;

}  // namespace ejecta::drag
