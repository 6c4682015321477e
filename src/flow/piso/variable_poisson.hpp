#pragma once
#include <array>

#include "flow/boundary.hpp"
#include "flow/poisson/fast_diagonal.hpp"
#include "grid/grid.hpp"

namespace ejecta {

/// The Poisson equation with a coefficient on every face,
///
///   sum over faces of (area c / distance) (phi_neighbour - phi_cell) = rhs_cell,
///
/// by conjugate gradients. Preconditioned with the direct solver of constant coefficient between divisions by
/// sqrt(c) (Concus & Golub 1973, SIAM J. Numer. Anal. 10:1103), exact where c is the same everywhere.
class VariablePoisson {
 public:
  VariablePoisson(const Grid& grid, const Boundaries& boundaries, FastDiagonalPoisson& constant);

  /// phi = solution of rhs for boundaries at which phi is zero or has no gradient, which there says c = 0.
  /// `faces`: c on the lower faces along each axis. `inverse_roots`: about 1 / sqrt(c) in the cells. Of rhs
  /// it leaves the residual. Stops when the root of the sum of its squares falls below `tolerance` (units of
  /// rhs), or no more can be gained. Iterations.
  int solve(const std::array<ConstFieldView, 3>& faces, ConstFieldView inverse_roots, FieldView rhs,
            double size, double tolerance, const std::array<FieldView, 3>& q, FieldView phi);
  /// sqrt of the sum of squares of what the last solution leaves
  double residual() const { return left_; }

 private:
  template <class Compute, class Value>
  double sum_rows(const Compute& compute, const Value& value) const;
  double precondition(ConstFieldView inverse_roots, ConstFieldView r);
  double apply(const std::array<ConstFieldView, 3>& faces);

  const Grid& grid_;
  const Boundaries& boundaries_;
  FastDiagonalPoisson& constant_;
  Field z_, direction_, image_;
  double left_ = 0;
};

}  // namespace ejecta
