#pragma once
#include <optional>

#include "grid/grid.hpp"

namespace ejecta {

/// Self-similar numbers of a steady round jet on an axisymmetric grid, along +z from the orifice.
struct RoundJet {
  double decay = 0.0;      ///< B in U_c/U_0 = B d/(z - z0), U_0 from the thrust through the orifice
  double spreading = 0.0;  ///< S, slope of the radius of half the axial velocity
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
