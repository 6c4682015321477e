#pragma once
#include <array>
#include <vector>

#include "base/simd.hpp"
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
  /// Lines along one axis run in blocks, side by side in lanes: along x kRegisterLanes rows of a piece, else
  /// kRealLanes cells of a row. Those of which solids cut a line have LU factors of their own,
  /// [block][cell][lane]: forward s_i = scale_i r_i + carry_i s_i-1, backward s_i += above_i s_i+1.
  struct CutBlocks {
    std::vector<int> number;  ///< of the factors of every block; -1: no solid cuts it
    std::vector<int> block;   ///< of every number
    std::vector<Real> scale, carry, above;
  };
  int block_of(int axis, int i, int j, int k) const;
  void list_blocks(const CutCells& cut);
  template <int kAxis>
  void factorise(int number, ConstFieldView carried, ConstFieldView closed);
  template <int kAxis>
  void factorise_all(const CutCells& cut, ConstFieldView carried);

  template <class Plain, class Cut>
  void smooth_row(int axis, const int* numbers, int m, const Plain& plain, const Cut& cut) const;
  void smooth_up(int axis, const int* numbers, int m, Real* row, const Real* before) const;
  void smooth_down(int axis, const int* numbers, int m, Real* row, const Real* after) const;
  void smooth_x(FieldView delta, int piece) const;
  void smooth_y(FieldView delta, int k) const;
  void smooth_z_and_add(FieldView delta, int j0, int j1, const Base& base) const;

  int nx_, ny_, nz_;
  std::array<bool, 3> active_;
  std::array<Operator1D, 3> operator_;
  std::array<Factors, 3> factors_;
  double nu_dt_ = 0;
  std::array<CutBlocks, 3> cut_;
  // Planes that one thread smooths along x and y at once, and blocks: of rows in them, of cells in a row
  int planes_together_, row_blocks_, cell_blocks_;
};

}  // namespace ejecta
