#pragma once
#include <vector>

#include "flow/ideal_gas.hpp"
#include "jet/model.hpp"
#include "jet/round_jet.hpp"

namespace ejecta {

/// The jet along its axis at one moment.
struct Centreline {
  std::vector<double> z;  ///< m above the orifice
  std::vector<JetSample> samples;
  std::vector<double>
      half_radius;  ///< m, where the axial velocity is half that on the axis; 0 where there is none
  std::vector<double> supersonic_radius;  ///< m, within which Mach 1 is reached; 0 where it is not
};

Centreline centreline(const JetModel& jet);

/// Mach disk and shock cells on a centreline. Zero where there are none.
struct ShockStructure {
  double mach_disk = 0.0;  ///< m: where the first supersonic stretch ends
  double peak_mach = 0.0;
  /// Highest pressure just behind the shock at `mach_disk` over that behind a normal shock at `peak_mach`: 1
  /// where there is a disk, twice as much where oblique shocks cross on the axis instead.
  double behind_over_normal_shock = 0.0;
  double first_cell = 0.0;              ///< m: first pressure maximum behind the first expansion
  std::vector<double> pressure_maxima;  ///< m
};
ShockStructure shock_structure(const Centreline& line, const Gas& gas);

/// Fitted over [from, to], m; U_0 is the momentum-equivalent velocity. Zeros where fewer than three heights
/// lie in between.
FarField far_field(const Centreline& line, double equivalent_velocity, double diameter, double from,
                   double to);

}  // namespace ejecta
