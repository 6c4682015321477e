#pragma once
#include <array>
#include <vector>

#include "flow/poisson/operator_1d.hpp"
#include "grid/grid.hpp"

namespace ejecta {

/// Implicit smoothing of the increment of an explicit step (Lerat, Sides & Daru 1982; Jameson's residual
/// smoothing):
///
///   (1 - nu dt Dxx)(1 - nu dt Dyy)(1 - nu dt Dzz) delta = dt R(u)
///
/// with one viscosity nu for the whole box. With nu at least half the largest eddy viscosity the explicit
/// viscous terms are stable at any dt. A steady state (delta = 0) is untouched, boundaries are closed, so
/// that the sum of what is added, momentum, is kept to round-off; what changes is only how fast waves shorter
/// than sqrt(nu dt) follow.
class IncrementSmoother {
 public:
  explicit IncrementSmoother(const Grid& grid);
  /// nu dt, m2. Allocates nothing.
  void prepare(double nu_dt);
  /// What the smoothed increment is added to: a one + b two.
  struct Base {
    ConstFieldView one;
    Real a;
    ConstFieldView two;
    Real b;
  };
  /// delta becomes base + smoothed delta.
  void apply(FieldView delta, const Base& base) const;

 private:
  void invert(int d, double nu_dt);

  int nx_, ny_, nz_;
  std::array<bool, 3> active_;
  std::array<Operator1D, 3> operator_;
  Field inverse_x_, inverse_y_;              // dense inverses, row-major (x: transposed, for rows)
  std::vector<Real> below_, above_, pivot_;  // of the tridiagonal system along z
  std::vector<double> lower_, upper_, diagonal_, solution_;
};

}  // namespace ejecta
