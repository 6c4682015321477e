#include "flow/poisson/fast_diagonal.hpp"

#include <Eigen/Eigenvalues>

#include "base/simd.hpp"
#include "flow/poisson/operator_1d.hpp"
#include "flow/poisson/small_gemm.hpp"

namespace ejecta {
namespace {

int padded(int n) { return (n + kRealLanes - 1) / kRealLanes * kRealLanes; }

}  // namespace

FastDiagonalPoisson::FastDiagonalPoisson(const Grid& grid, const std::array<PoissonBoundary, 6>& b)
    : nx_(grid.nx()),
      ny_(grid.ny()),
      nz_(grid.nz()),
      z_periodic_(b[4] == PoissonBoundary::periodic && nz_ > 1),
      work_(grid.make_field()) {
  axis_[0] = diagonalise(grid, 0, b[0], b[1]);
  axis_[1] = diagonalise(grid, 1, b[2], b[3]);
  if (z_periodic_) axis_[2] = diagonalise(grid, 2, b[4], b[5]);
  else prepare_tridiagonal(grid, b[4], b[5]);
}

FastDiagonalPoisson::Axis1D FastDiagonalPoisson::diagonalise(const Grid& grid, int d, PoissonBoundary lower,
                                                             PoissonBoundary upper) const {
  const int n = grid.n(d);
  const Operator1D op = operator_1d(grid, d, lower, upper);
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(n, n);
  const auto couple = [&](int a, int b, double c) {
    m(a, a) -= c / op.volume[a];
    m(b, b) -= c / op.volume[b];
    m(a, b) += c / std::sqrt(op.volume[a] * op.volume[b]);
    m(b, a) += c / std::sqrt(op.volume[a] * op.volume[b]);
  };
  for (int i = 1; i < n; ++i) couple(i - 1, i, op.coupling[i]);
  if (lower == PoissonBoundary::periodic && n > 1) couple(n - 1, 0, op.coupling[0]);
  if (lower == PoissonBoundary::dirichlet) m(0, 0) -= op.coupling[0] / op.volume[0];
  if (upper == PoissonBoundary::dirichlet) m(n - 1, n - 1) -= op.coupling[n] / op.volume[n - 1];
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(m);

  Axis1D a{{eigen.eigenvalues().data(), eigen.eigenvalues().data() + n}, Field(n, n, 1), Field(n, n, 1)};
  // x multiplies rows from the right (forward = M^-1/2 Q), y and z multiply columns from the left.
  for (int i = 0; i < n; ++i)
    for (int e = 0; e < n; ++e) {
      const Real value = static_cast<Real>(eigen.eigenvectors()(i, e) / std::sqrt(op.volume[i]));
      (d == 0 ? a.forward(e, i, 0) : a.forward(i, e, 0)) = value;
      (d == 0 ? a.backward(i, e, 0) : a.backward(e, i, 0)) = value;
    }
  return a;
}

void FastDiagonalPoisson::prepare_tridiagonal(const Grid& grid, PoissonBoundary lower,
                                              PoissonBoundary upper) {
  const Operator1D op = operator_1d(grid, 2, lower, upper);
  coupling_.assign(op.coupling.begin(), op.coupling.end());
  inverse_pivot_ = grid.make_field();
  const double largest = -axis_[0].eigenvalue.front() - axis_[1].eigenvalue.front();
  for (int j = 0; j < ny_; ++j)
    for (int i = 0; i < nx_; ++i) {
      double lambda = axis_[0].eigenvalue[i] + axis_[1].eigenvalue[j];
      if (-lambda < 1e-12 * largest) lambda = 0.0;  // the constant mode, up to round-off
      double inverse = 0.0;
      for (int k = 0; k < nz_; ++k) {
        const double below = k > 0 ? op.coupling[k] : 0.0;
        const double outer = op.coupling[k] + op.coupling[k + 1];
        const double diagonal = lambda * op.volume[k] - outer;
        const double pivot = diagonal - below * below * inverse;
        // The constant mode of a closed box has no equation: its last pivot vanishes, phi is pinned there.
        const bool vanishes = std::abs(pivot) < 1e-9 * (std::abs(diagonal) + outer) || pivot == 0.0;
        inverse = vanishes ? 0.0 : 1.0 / pivot;
        inverse_pivot_(i, j, k) = static_cast<Real>(inverse);
      }
    }
}

void FastDiagonalPoisson::solve(ConstFieldView rhs, FieldView phi) {
  const int ldx = padded(nx_);
  const FieldView work = work_.view();
  const auto square = [](Axis1D& a) { return std::pair(a.forward.view(), a.backward.view()); };
  const auto [fx, bx] = square(axis_[0]);
  const auto [fy, by] = square(axis_[1]);
  const std::size_t plane = static_cast<std::size_t>(ldx) * static_cast<std::size_t>(ny_);
  for_each_index(nz_, [&](int k) {
    Real* scratch = thread_scratch(plane);
    small_gemm(ny_, ldx, ny_, fy.origin, int(fy.sy), rhs.row(0, k), int(rhs.sy), scratch, ldx);
    small_gemm(ny_, ldx, nx_, scratch, ldx, fx.origin, int(fx.sy), work.row(0, k), int(work.sy));
  });
  z_periodic_ ? solve_periodic_z() : solve_tridiagonal();
  for_each_index(nz_, [&](int k) {
    Real* scratch = thread_scratch(plane);
    small_gemm(ny_, ldx, nx_, work.row(0, k), int(work.sy), bx.origin, int(bx.sy), scratch, ldx);
    small_gemm(ny_, ldx, ny_, by.origin, int(by.sy), scratch, ldx, phi.row(0, k), int(phi.sy));
  });
}

void FastDiagonalPoisson::solve_tridiagonal() {
  const FieldView work = work_.view(), pivot = inverse_pivot_.view();
  for_each_index(ny_, [&](int j) {
    for (int k = 0; k < nz_; ++k) {
      Real* row = work.row(j, k);
      const Real* inverse = pivot.row(j, k);
      const Real* below = work.row(j, k - 1);
      const Real c = k > 0 ? coupling_[k] : Real(0);
      for_each_lane(0, nx_, [&](int i) { row[i] = (row[i] - c * below[i]) * inverse[i]; });
    }
    for (int k = nz_ - 2; k >= 0; --k) {
      Real* row = work.row(j, k);
      const Real* inverse = pivot.row(j, k);
      const Real* above = work.row(j, k + 1);
      const Real c = coupling_[k + 1];
      for_each_lane(0, nx_, [&](int i) { row[i] -= c * inverse[i] * above[i]; });
    }
  });
}

void FastDiagonalPoisson::solve_periodic_z() {
  const int ldx = padded(nx_);
  const FieldView work = work_.view();
  const FieldView fz = axis_[2].forward.view(), bz = axis_[2].backward.view();
  const double largest =
      -axis_[0].eigenvalue.front() - axis_[1].eigenvalue.front() - axis_[2].eigenvalue.front();
  for_each_index(ny_, [&](int j) {
    Real* hat = thread_scratch(static_cast<std::size_t>(ldx) * static_cast<std::size_t>(nz_));
    small_gemm(nz_, ldx, nz_, fz.origin, int(fz.sy), work.row(j, 0), int(work.sz), hat, ldx);
    for (int e = 0; e < nz_; ++e)
      for (int i = 0; i < nx_; ++i) {
        const double lambda = axis_[0].eigenvalue[i] + axis_[1].eigenvalue[j] + axis_[2].eigenvalue[e];
        hat[e * ldx + i] = -lambda < 1e-12 * largest ? Real(0) : static_cast<Real>(hat[e * ldx + i] / lambda);
      }
    small_gemm(nz_, ldx, nz_, bz.origin, int(bz.sy), hat, ldx, work.row(j, 0), int(work.sz));
  });
}

}  // namespace ejecta
