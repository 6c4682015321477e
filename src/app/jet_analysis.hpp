#pragma once
#include <vector>

#include "app/jet_model.hpp"

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
  double first_cell = 0.0;              ///< m: first pressure maximum behind the first expansion
  std::vector<double> pressure_maxima;  ///< m
};
ShockStructure shock_structure(const Centreline& line);

/// Self-similar far field fitted over [from, to] by least squares: U_0/U_c = (z - z0)/(B d) and
/// r_half = S (z - z1).
struct FarField {
  double decay = 0.0;           ///< B, on the momentum-equivalent velocity
  double spreading = 0.0;       ///< S
  double virtual_origin = 0.0;  ///< z0, m
};
FarField far_field(const Centreline& line, double equivalent_velocity, double diameter, double from,
                   double to);

}  // namespace ejecta
