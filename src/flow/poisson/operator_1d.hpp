#pragma once
#include <vector>

#include "flow/poisson/fast_diagonal.hpp"
#include "grid/grid.hpp"

namespace ejecta {

/// The Laplacian along one axis, in double from the axis itself: volumes of the n cells and couplings (area /
/// distance) of the n + 1 faces.
struct Operator1D {
  std::vector<double> volume, coupling;
};

/// A closed (Neumann) boundary couples with 0, a Dirichlet one over half a cell.
Operator1D operator_1d(const Grid& grid, int d, PoissonBoundary lower, PoissonBoundary upper);

}  // namespace ejecta
