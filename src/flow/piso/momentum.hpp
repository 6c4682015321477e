#pragma once
#include <array>
#include <vector>

#include "base/vec.hpp"
#include "grid/grid.hpp"

namespace ejecta {

/// Views of one momentum predictor (paper Eq. 2 with constant density):
///
///   base = a old + b u,   increment = b dt [ -div(q u) + div(2 nu_eff S) - grad p + acceleration + source ]
///
/// out = base + increment, or the increment alone.
/// Convection by limited second-order upwind values, full viscous stress. u and p have filled ghosts.
struct MomentumTerms {
  std::array<ConstFieldView, 3> old, u;
  std::array<ConstFieldView, 3> face_velocity;  ///< q, divergence-free
  ConstFieldView pressure;                      ///< p / rho, m2/s2; origin null: none
  ConstFieldView eddy_viscosity;                ///< m2/s; origin null: laminar
  std::array<ConstFieldView, 3> source;         ///< m/s2; origin null: none
  std::array<FieldView, 3> out;
  std::array<Real, 3> acceleration{0, 0, 0};  ///< m/s2
  Real viscosity = 0;                         ///< nu, m2/s
  Real a = 0, b = 1, dt = 0;
  bool increment_only = false;
};

/// What crosses the boundaries of the box, counted on their faces and not from the cells' balances, so that
/// the ledger can tell whether anything was lost inside. Positive into the box.
struct BoundaryFlow {
  Vec3 momentum{0, 0, 0};  ///< convection and viscous stress over density, m4/s2
  double volume = 0;       ///< net, m3/s
  double volume_in = 0;    ///< m3/s
  BoundaryFlow& operator-=(const BoundaryFlow& o) {
    momentum -= o.momentum;
    volume -= o.volume;
    volume_in -= o.volume_in;
    return *this;
  }
};

/// What passes a face along d, of every component: the value carried by the flow through it, m/s, and the
/// viscous stress over density, m2/s2. The lower face of cell (i, j, k).
struct FaceMomentum {
  std::array<Real, 3> carried, stress;
};
FaceMomentum momentum_at_face(const Grid& grid, const MomentumTerms& terms, int d, int i, int j, int k);

/// Computes terms.out and returns what crossed the boundaries. `scratch` has room for nz + 2 ny entries.
BoundaryFlow predict_momentum(const Grid& grid, const MomentumTerms& terms,
                              std::vector<BoundaryFlow>& scratch);

/// Force of the pressure on the fluid at the boundaries, over density, m4/s2. p has filled ghosts.
Vec3 boundary_pressure(const Grid& grid, ConstFieldView p);

}  // namespace ejecta
