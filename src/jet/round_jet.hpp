#pragma once
#include <optional>
#include <vector>

#include "grid/grid.hpp"

namespace ejecta {

/// Self-similar far field of a round jet: U_0/U_c = (z - z0)/(B d), r_half = S (z - z1).
struct FarField {
  double decay = 0.0;           ///< B
  double spreading = 0.0;       ///< S
  double virtual_origin = 0.0;  ///< z0, m
};

/// By least squares, from heights z (m), U_0/U_c and r_half (m) there.
FarField fit_far_field(const std::vector<double>& z, const std::vector<double>& inverse_velocity,
                       const std::vector<double>& half_radius, double orifice_diameter);

/// A steady round jet on an axisymmetric grid, along +z from the orifice.
struct RoundJet {
  FarField far;  ///< U_0 from the thrust through the orifice
  double momentum_variation =
      0.0;  ///< (largest - smallest) / mean of the momentum flux over the fitted stretch
};

/// Fits over z in [from, to], m. `p` is pressure over density; momentum flux = integral of w^2 + p - 2 nu_eff
/// dw/dz. Nothing where fewer than five planes lie in between.
std::optional<RoundJet> analyse_round_jet(const Grid& grid, ConstFieldView w, ConstFieldView p,
                                          ConstFieldView eddy_viscosity, double viscosity,
                                          double orifice_diameter, double exit_velocity, double from,
                                          double to);

}  // namespace ejecta
