#pragma once
#include <array>

#include "grid/grid.hpp"

namespace ejecta {

/// Views of one momentum predictor (paper Eq. 2 with constant density):
///
///   out = a old + b (u + dt [ -div(q u) + div(2 nu_eff S) - grad p + acceleration + source ])
///
/// Convection by limited second-order upwind values, full viscous stress. u and p have filled ghosts.
struct MomentumTerms {
  std::array<ConstFieldView, 3> old, u;
  std::array<ConstFieldView, 3> face_velocity;  ///< q, divergence-free
  ConstFieldView pressure;                      ///< p / rho, m2/s2
  ConstFieldView eddy_viscosity;                ///< m2/s; origin null: laminar
  std::array<ConstFieldView, 3> source;         ///< m/s2; origin null: none
  std::array<FieldView, 3> out;
  std::array<Real, 3> acceleration{0, 0, 0};  ///< m/s2
  Real viscosity = 0;                         ///< nu, m2/s
  Real a = 0, b = 1, dt = 0;
};

void predict_momentum(const Grid& grid, const MomentumTerms& terms);

}  // namespace ejecta
