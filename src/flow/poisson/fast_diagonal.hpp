#pragma once
#include <array>
#include <vector>

#include "grid/grid.hpp"

namespace ejecta {

enum class PoissonBoundary { neumann, dirichlet, periodic };

/// Exact direct solver of the discrete Poisson equation on a tensor-product grid (fast diagonalisation,
/// Lynch, Rice & Thomas 1964):
///
///   sum over faces of (area / distance) (phi_neighbour - phi_cell) = rhs_cell     (volume-integrated)
///
/// with zero gradient (Neumann), phi = 0 on the face (Dirichlet) or periodic boundaries, one kind a face of
/// the box. The 1D operators of x and y are diagonalised once; a solve transforms with small dense
/// products and solves tridiagonal systems along z (or transforms along z too where z is periodic). Where all
/// boundaries are Neumann or periodic, phi is fixed up to a constant; the incompatible mean of rhs is
/// ignored.
class FastDiagonalPoisson {
 public:
  FastDiagonalPoisson(const Grid& grid, const std::array<PoissonBoundary, 6>& boundary);

  /// phi = solution of rhs; only inner cells are read and written. The two may be the same field.
  void solve(ConstFieldView rhs, FieldView phi);

  /// A box of cells in which a right-hand side differs from zero and where alone its solution is asked for:
  /// costs what the box is large, not the grid.
  struct Window {
    Range3 cells;
    int width = 0;             ///< of its rows in `values`, whole registers from column `first` on
    int first = 0;             ///< first column, a whole number of registers
    std::vector<Real> values;  ///< right-hand side, then solution: [k][j][i - first], 64-byte aligned
    std::vector<Real> modes;   ///< scratch
    Real* row(int j, int k) {
      return aligned() +
             (static_cast<std::ptrdiff_t>(k - cells.k0) * (cells.j1 - cells.j0) + j - cells.j0) * width;
    }
    Real* aligned();
  };
  void resize(Window& w, const Range3& cells) const;
  void solve(Window& w);
  /// solve() in parts, between which sources within a window are added for little:
  void begin(ConstFieldView rhs);  ///< the solution of rhs, not yet transformed back
  void read(Window& w);            ///< its values in the window
  void add(Window& w);             ///< adds the solution of the window's values
  void finish(FieldView phi);
  bool has_windows() const { return !z_periodic_; }

 private:
  struct Axis1D {
    std::vector<double> eigenvalue;
    Field forward, backward;  // row-major n x n in one plane, padded rows
  };
  Axis1D diagonalise(const Grid& grid, int d, PoissonBoundary lower, PoissonBoundary upper) const;
  void prepare_tridiagonal(const Grid& grid, PoissonBoundary lower, PoissonBoundary upper);
  void solve_tridiagonal();
  Real* transform(Window& w);
  void transform_back(Window& w, const Real* modes, std::ptrdiff_t plane, int ld);
  void solve_periodic_z();

  int nx_, ny_, nz_;
  bool z_periodic_;
  std::array<Axis1D, 3> axis_;
  Field work_, inverse_pivot_;
  Field added_;                 // modes of what is added
  Field inverse_pivot_above_;   // the same, eliminated from above
  std::vector<Real> coupling_;  // entry k couples cells k-1 and k
};

}  // namespace ejecta
