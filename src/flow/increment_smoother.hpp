#pragma once
#include <array>
#include <vector>

#include "flow/cut_cells.hpp"
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
  /// nu dt, m2. Lines of cells that solids cut are smoothed on their own: nothing passes closed faces, and
  /// what is kept is the sum over the fluid. `carried`: part of a cell's volume that counts, 0 in solids.
  void prepare(double nu_dt, const CutCells& cut, ConstFieldView carried);
  /// What the smoothed increment is added to, a one + b two; `positive`: it is and stays so (positive_sum).
  struct Base {
    ConstFieldView one;
    Real a;
    ConstFieldView two;
    Real b;
    bool positive = false;
  };
  /// delta becomes base + smoothed delta.
  void apply(FieldView delta, const Base& base) const;

 private:
  /// LU factors of 1 - nu dt D along one axis: forward s_i = inverse_i r_i - below_i s_i-1, backward
  /// s_i -= above_i s_i+1.
  struct Factors {
    std::vector<Real> inverse, below, above;
  };
  /// A line of cells along an axis, by its indices along the other two in ascending order.
  struct Line {
    int a, b;
  };
  /// Calls smooth() for everything, but puts what it did to the lines [first, last) of an axis right.
  template <class Smooth>
  void with_cut_lines(FieldView delta, int axis, int first, int last, const Base* base,
                      const Smooth& smooth) const;
  void solve_line(int axis, Line line, Real* values) const;
  void list_lines(const CutCells& cut);

  void smooth_x(FieldView delta, int first, int last) const;
  void smooth_y(FieldView delta, int k) const;
  void smooth_z_and_add(FieldView delta, int j0, int j1, const Base& base) const;

  int nx_, ny_, nz_;
  std::array<bool, 3> active_;
  std::array<Operator1D, 3> operator_;
  std::array<Factors, 3> factors_;
  double nu_dt_ = 0;
  ConstFieldView carried_;
  std::array<ConstFieldView, 3> closed_;
  std::array<std::vector<Line>, 3> lines_;      // that solids cut, by axis; sorted by b, in z by b = j
  std::array<std::vector<int>, 3> first_line_;  // of every b, and their number
  std::vector<char> marked_;                    // scratch
};

}  // namespace ejecta
