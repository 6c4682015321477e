#include "flow/poisson/fast_diagonal.hpp"

#include <Eigen/Eigenvalues>
#include <cstdint>

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
  inverse_pivot_above_ = grid.make_field();
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
      const bool pinned = inverse == 0.0;
      inverse = 0.0;
      for (int k = nz_ - 1; k >= 0; --k) {
        const double above = k + 1 < nz_ ? op.coupling[k + 1] : 0.0;
        const double pivot =
            lambda * op.volume[k] - op.coupling[k] - op.coupling[k + 1] - above * above * inverse;
        inverse = (pinned && k == nz_ - 1) || pivot == 0.0 ? 0.0 : 1.0 / pivot;
        inverse_pivot_above_(i, j, k) = static_cast<Real>(inverse);
      }
    }
}

void FastDiagonalPoisson::solve(ConstFieldView rhs, FieldView phi) {
  begin(rhs);
  finish(phi);
}

void FastDiagonalPoisson::begin(ConstFieldView rhs) {
  const int ldx = padded(nx_);
  const FieldView work = work_.view(), fx = axis_[0].forward.view(), fy = axis_[1].forward.view();
  for_each_index(nz_, [&](int k) {
    Real* scratch = thread_scratch(static_cast<std::size_t>(ldx) * static_cast<std::size_t>(ny_));
    small_gemm(ny_, ldx, ny_, fy.origin, int(fy.sy), rhs.row(0, k), int(rhs.sy), scratch, ldx);
    small_gemm(ny_, ldx, nx_, scratch, ldx, fx.origin, int(fx.sy), work.row(0, k), int(work.sy));
  });
  z_periodic_ ? solve_periodic_z() : solve_tridiagonal();
}

void FastDiagonalPoisson::finish(FieldView phi) {
  const int ldx = padded(nx_);
  const FieldView work = work_.view(), bx = axis_[0].backward.view(), by = axis_[1].backward.view();
  for_each_index(nz_, [&](int k) {
    Real* scratch = thread_scratch(static_cast<std::size_t>(ldx) * static_cast<std::size_t>(ny_));
    small_gemm(ny_, ldx, nx_, work.row(0, k), int(work.sy), bx.origin, int(bx.sy), scratch, ldx);
    small_gemm(ny_, ldx, ny_, by.origin, int(by.sy), scratch, ldx, phi.row(0, k), int(phi.sy));
  });
}

Real* FastDiagonalPoisson::Window::aligned() {
  const std::uintptr_t at = reinterpret_cast<std::uintptr_t>(values.data());
  return values.data() + (63 - (at + 63) % 64) / sizeof(Real);
}

void FastDiagonalPoisson::resize(Window& w, const Range3& cells) const {
  w.cells = cells;
  w.first = cells.i0 / kRealLanes * kRealLanes;
  w.width = padded(cells.i1 - w.first);
  const std::size_t planes = static_cast<std::size_t>(cells.k1 - cells.k0),
                    rows = static_cast<std::size_t>(cells.j1 - cells.j0);
  w.values.assign(planes * rows * static_cast<std::size_t>(w.width) + kRealLanes, Real(0));
  w.modes.resize(planes * static_cast<std::size_t>(ny_) * static_cast<std::size_t>(padded(nx_)) + kRealLanes);
}

Real* FastDiagonalPoisson::transform(Window& w) {
  const Range3& c = w.cells;
  const int ldx = padded(nx_), rows = c.j1 - c.j0, columns = c.i1 - w.first;
  const FieldView fx = axis_[0].forward.view(), fy = axis_[1].forward.view();
  const std::uintptr_t at = reinterpret_cast<std::uintptr_t>(w.modes.data());
  Real* modes = w.modes.data() + (63 - (at + 63) % 64) / sizeof(Real);
  const std::ptrdiff_t plane = static_cast<std::ptrdiff_t>(ldx) * ny_;
  for_each_index(c.k1 - c.k0, [&](int k) {
    Real* scratch = thread_scratch(static_cast<std::size_t>(w.width) * static_cast<std::size_t>(ny_));
    small_gemm(ny_, w.width, rows, fy.row(0, 0) + c.j0, int(fy.sy), w.row(c.j0, c.k0 + k), w.width, scratch,
               w.width);
    small_gemm(ny_, ldx, columns, scratch, w.width, fx.row(w.first, 0), int(fx.sy), modes + k * plane, ldx);
  });
  return modes;
}

void FastDiagonalPoisson::transform_back(Window& w, const Real* modes, std::ptrdiff_t plane, int ld) {
  const Range3& c = w.cells;
  const FieldView bx = axis_[0].backward.view(), by = axis_[1].backward.view();
  for_each_index(c.k1 - c.k0, [&](int k) {
    Real* scratch = thread_scratch(static_cast<std::size_t>(w.width) * static_cast<std::size_t>(ny_));
    small_gemm(ny_, w.width, nx_, modes + k * plane, ld, bx.row(0, 0) + w.first, int(bx.sy), scratch,
               w.width);
    small_gemm(c.j1 - c.j0, w.width, ny_, by.row(c.j0, 0), int(by.sy), scratch, w.width,
               w.row(c.j0, c.k0 + k), w.width);
  });
}

void FastDiagonalPoisson::read(Window& w) {
  const FieldView work = work_.view();
  transform_back(w, work.row(0, w.cells.k0), work.sz, int(work.sy));
}

void FastDiagonalPoisson::add(Window& w) {
  const Range3& c = w.cells;
  const Real* modes = transform(w);
  const int ldx = padded(nx_);
  const std::ptrdiff_t plane = static_cast<std::ptrdiff_t>(ldx) * ny_;
  if (added_.size() == 0) added_ = Field(nx_, ny_, nz_);
  const FieldView work = work_.view(), added = added_.view(), pivot = inverse_pivot_.view();
  for_each_index(ny_, [&](int j) {
    for (int k = c.k0; k < nz_; ++k) {
      Real* row = added.row(j, k);
      const Real *inverse = pivot.row(j, k), *below = added.row(j, k - 1);
      const Real coupling = k > c.k0 ? coupling_[static_cast<std::size_t>(k)] : Real(0);
      const Real* source = modes + (k - c.k0) * plane + static_cast<std::ptrdiff_t>(j) * ldx;
      if (k == c.k0) for_each_lane(0, nx_, [&](int i) { row[i] = source[i] * inverse[i]; });
      else if (k < c.k1)
        for_each_lane(0, nx_, [&](int i) { row[i] = (source[i] - coupling * below[i]) * inverse[i]; });
      else for_each_lane(0, nx_, [&](int i) { row[i] = -coupling * below[i] * inverse[i]; });
    }
    for (int k = nz_ - 1; k >= 0; --k) {
      Real *row = added.row(j, k), *sum = work.row(j, k);
      const Real *inverse = pivot.row(j, k), *above = added.row(j, k + 1);
      const Real coupling = k + 1 < nz_ ? coupling_[static_cast<std::size_t>(k + 1)] : Real(0);
      if (k + 1 == nz_) {
      } else if (k >= c.k0) for_each_lane(0, nx_, [&](int i) { row[i] -= coupling * inverse[i] * above[i]; });
      else for_each_lane(0, nx_, [&](int i) { row[i] = -coupling * inverse[i] * above[i]; });
      for_each_lane(0, nx_, [&](int i) { sum[i] += row[i]; });
    }
  });
}

void FastDiagonalPoisson::solve(Window& w) {
  const Range3& c = w.cells;
  const int ldx = padded(nx_);
  const std::ptrdiff_t plane = static_cast<std::ptrdiff_t>(ldx) * ny_;
  Real* modes = transform(w);
  // Nothing comes from below the window, and what is above it answers in proportion.
  const FieldView pivot = inverse_pivot_.view(), above = inverse_pivot_above_.view();
  for_each_index(ny_, [&](int j) {
    const auto row = [&](int k) { return modes + (k - c.k0) * plane + static_cast<std::ptrdiff_t>(j) * ldx; };
    for (int k = c.k0; k < c.k1; ++k) {
      Real* here = row(k);
      const Real* inverse = pivot.row(j, k);
      const Real* below = k > c.k0 ? row(k - 1) : here;
      const Real coupling = k > c.k0 ? coupling_[static_cast<std::size_t>(k)] : Real(0);
      for_each_lane(0, nx_, [&](int i) { here[i] = (here[i] - coupling * below[i]) * inverse[i]; });
    }
    if (c.k1 < nz_) {
      Real* last = row(c.k1 - 1);
      const Real *inverse = pivot.row(j, c.k1 - 1), *up = above.row(j, c.k1);
      const Real square_of =
          coupling_[static_cast<std::size_t>(c.k1)] * coupling_[static_cast<std::size_t>(c.k1)];
      for_each_lane(0, nx_, [&](int i) { last[i] /= Real(1) - square_of * inverse[i] * up[i]; });
    }
    for (int k = c.k1 - 2; k >= c.k0; --k) {
      Real* here = row(k);
      const Real *inverse = pivot.row(j, k), *next = row(k + 1);
      const Real coupling = coupling_[static_cast<std::size_t>(k + 1)];
      for_each_lane(0, nx_, [&](int i) { here[i] -= coupling * inverse[i] * next[i]; });
    }
  });
  transform_back(w, modes, plane, ldx);
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
