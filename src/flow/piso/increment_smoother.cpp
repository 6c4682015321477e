#include "flow/piso/increment_smoother.hpp"

#include <algorithm>

#include "base/simd.hpp"
#include "flow/poisson/small_gemm.hpp"

namespace ejecta {

IncrementSmoother::IncrementSmoother(const Grid& grid)
    : nx_(grid.nx()),
      ny_(grid.ny()),
      nz_(grid.nz()),
      active_{grid.active(0), grid.active(1), grid.active(2)},
      inverse_x_(nx_, nx_, 1),
      inverse_y_(ny_, ny_, 1) {
  for (int d = 0; d < 3; ++d)
    operator_[static_cast<std::size_t>(d)] =
        operator_1d(grid, d, PoissonBoundary::neumann, PoissonBoundary::neumann);
  const std::size_t longest = static_cast<std::size_t>(std::max({nx_, ny_, nz_}));
  for (auto* v : {&lower_, &upper_, &diagonal_, &solution_}) v->resize(longest);
  for (auto* v : {&below_, &above_, &pivot_}) v->resize(static_cast<std::size_t>(nz_));
}

void IncrementSmoother::prepare(double nu_dt) {
  for (int d = 0; d < 3; ++d)
    if (active_[static_cast<std::size_t>(d)]) invert(d, nu_dt);
}

/// Thomas factors of 1 - nu dt D along one axis; along x and y also the dense inverse, column by column.
void IncrementSmoother::invert(int d, double nu_dt) {
  const Operator1D& op = operator_[static_cast<std::size_t>(d)];
  const int n = static_cast<int>(op.volume.size());
  for (int i = 0; i < n; ++i) {
    const std::size_t at = static_cast<std::size_t>(i);
    const double low = nu_dt * op.coupling[at] / op.volume[at],
                 up = nu_dt * op.coupling[at + 1] / op.volume[at];
    lower_[at] = -low;
    upper_[at] = -up;
    // 1 / pivot of the forward elimination
    diagonal_[at] = 1.0 / (1.0 + low + up - (i > 0 ? lower_[at] * upper_[at - 1] * diagonal_[at - 1] : 0.0));
  }
  if (d == 2) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(n); ++k) {
      below_[k] = static_cast<Real>(lower_[k]);
      above_[k] = static_cast<Real>(upper_[k] * diagonal_[k]);
      pivot_[k] = static_cast<Real>(diagonal_[k]);
    }
    return;
  }
  for (int column = 0; column < n; ++column) {
    for (int i = 0; i < n; ++i) {
      const std::size_t at = static_cast<std::size_t>(i);
      const double right = i == column ? 1.0 : 0.0;
      solution_[at] = (right - (i > 0 ? lower_[at] * solution_[at - 1] : 0.0)) * diagonal_[at];
    }
    for (int i = n - 2; i >= 0; --i) {
      const std::size_t at = static_cast<std::size_t>(i);
      solution_[at] -= upper_[at] * diagonal_[at] * solution_[at + 1];
    }
    for (int i = 0; i < n; ++i) {
      const Real value = static_cast<Real>(solution_[static_cast<std::size_t>(i)]);
      if (d == 0) inverse_x_(i, column, 0) = value;  // rows are multiplied from the right
      else inverse_y_(column, i, 0) = value;
    }
  }
}

void IncrementSmoother::apply(FieldView delta, const Base& base) const {
  const int ld = (nx_ + kLanes - 1) / kLanes * kLanes;
  const ConstFieldView x = inverse_x_.view(), y = inverse_y_.view();
  for_each_index(nz_, [&](int k) {
    Real* scratch = thread_scratch(static_cast<std::size_t>(ld) * static_cast<std::size_t>(ny_));
    Real* plane = delta.row(0, k);
    const int ldp = static_cast<int>(delta.sy);
    if (active_[1]) small_gemm(ny_, ld, ny_, y.origin, static_cast<int>(y.sy), plane, ldp, scratch, ld);
    else std::copy_n(plane, nx_, scratch);
    if (active_[0]) small_gemm(ny_, ld, nx_, scratch, ld, x.origin, static_cast<int>(x.sy), plane, ldp);
    else
      for (int j = 0; j < ny_; ++j) plane[j * ldp] = scratch[j * ld];
  });
  for_each_index(ny_, [&](int j) {
    for (int k = 0; active_[2] && k < nz_; ++k) {
      const std::size_t at = static_cast<std::size_t>(k);
      Real* row = delta.row(j, k);
      const Real* before = delta.row(j, k - 1);
      const Real pivot = pivot_[at], below = k > 0 ? below_[at] : Real(0);
      for_each_lane(0, nx_, [=](int i) { row[i] = (row[i] - below * before[i]) * pivot; });
    }
    // Backward; a row is added to its base as soon as the row below no longer needs it.
    for (int k = nz_ - 1; k >= 0; --k) {
      Real* row = delta.row(j, k);
      Real* below = k > 0 ? delta.row(j, k - 1) : nullptr;
      const Real above = active_[2] && k > 0 ? above_[static_cast<std::size_t>(k) - 1] : Real(0);
      const Real *one = base.one.row(j, k), *two = base.two.row(j, k);
      const Real a = base.a, b = base.b;
      if (below)
        for_each_lane(0, nx_, [=](int i) {
          below[i] -= above * row[i];
          row[i] += a * one[i] + b * two[i];
        });
      else for_each_lane(0, nx_, [=](int i) { row[i] += a * one[i] + b * two[i]; });
    }
  });
}

}  // namespace ejecta
