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

 private:
  struct Axis1D {
    std::vector<double> eigenvalue;
    Field forward, backward;  // row-major n x n in one plane, padded rows
  };
  Axis1D diagonalise(const Grid& grid, int d, PoissonBoundary lower, PoissonBoundary upper) const;
  void prepare_tridiagonal(const Grid& grid, PoissonBoundary lower, PoissonBoundary upper);
  void solve_tridiagonal();
  void solve_periodic_z();

  int nx_, ny_, nz_;
  bool z_periodic_;
  std::array<Axis1D, 3> axis_;
  Field work_, inverse_pivot_;
  std::vector<Real> coupling_;  // entry k couples cells k-1 and k
};

}  // namespace ejecta
