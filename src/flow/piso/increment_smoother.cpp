#include "flow/piso/increment_smoother.hpp"

#include <algorithm>

#include "base/simd.hpp"

namespace ejecta {
namespace {

/// Rows of a plane that the sweep along z takes together: side by side in memory, as the prefetcher likes
/// them, and few enough to stay in cache from the way up to the way down.
constexpr int kRowsTogether = 8;

}  // namespace

IncrementSmoother::IncrementSmoother(const Grid& grid)
    : nx_(grid.nx()),
      ny_(grid.ny()),
      nz_(grid.nz()),
      active_{grid.active(0), grid.active(1), grid.active(2)} {
  for (int d = 0; d < 3; ++d) {
    operator_[static_cast<std::size_t>(d)] =
        operator_1d(grid, d, PoissonBoundary::neumann, PoissonBoundary::neumann);
    Factors& f = factors_[static_cast<std::size_t>(d)];
    for (auto* v : {&f.inverse, &f.below, &f.above}) v->resize(static_cast<std::size_t>(grid.n(d)));
  }
}

void IncrementSmoother::prepare(double nu_dt) {
  for (std::size_t d = 0; d < 3; ++d) {
    const Operator1D& op = operator_[d];
    Factors& f = factors_[d];
    double above = 0.0;  // upper coefficient of the row before over its pivot
    for (std::size_t i = 0; i < op.volume.size(); ++i) {
      const double low = nu_dt * op.coupling[i] / op.volume[i],
                   up = nu_dt * op.coupling[i + 1] / op.volume[i];
      const double inverse = 1.0 / (1.0 + low + up + low * above);
      above = -up * inverse;
      f.inverse[i] = static_cast<Real>(inverse);
      f.below[i] = static_cast<Real>(-low * inverse);
      f.above[i] = static_cast<Real>(above);
    }
  }
}

/// Along x the recurrence runs over the registers of kRealLanes rows at once, transposed there and back. Rows
/// [first, last) are counted plane by plane.
void IncrementSmoother::smooth_x(FieldView delta, int first, int last) const {
  const int width = (nx_ + kRealLanes - 1) / kRealLanes * kRealLanes;
  RealLanes* column =
      reinterpret_cast<RealLanes*>(thread_scratch(static_cast<std::size_t>(width * kRealLanes)));
  const Factors& f = factors_[0];
  const auto row = [&](int n) { return delta.row(n % ny_, n / ny_); };
  for (int n0 = first; n0 < last; n0 += kRealLanes) {
    const int rows = std::min(kRealLanes, last - n0);
    RealLanes tile[kRealLanes];
    for (int i0 = 0; i0 < width; i0 += kRealLanes) {
      for (int n = 0; n < kRealLanes; ++n)
        tile[n] = *reinterpret_cast<const RealLanes*>(row(n0 + std::min(n, rows - 1)) + i0);
      transpose(tile);
      std::copy_n(tile, kRealLanes, column + i0);
    }
    RealLanes s = column[0] * f.inverse[0];
    column[0] = s;
    for (int i = 1; i < nx_; ++i) {
      const std::size_t at = static_cast<std::size_t>(i);
      s = column[i] * f.inverse[at] - f.below[at] * s;
      column[i] = s;
    }
    for (int i = nx_ - 2; i >= 0; --i) {
      s = column[i] - f.above[static_cast<std::size_t>(i)] * s;
      column[i] = s;
    }
    for (int i0 = 0; i0 < width; i0 += kRealLanes) {
      std::copy_n(column + i0, kRealLanes, tile);
      transpose(tile);
      for (int n = 0; n < rows; ++n) *reinterpret_cast<RealLanes*>(row(n0 + n) + i0) = tile[n];
    }
  }
}

void IncrementSmoother::smooth_y(FieldView delta, int k) const {
  const Factors& f = factors_[1];
  for (int j = 0; j < ny_; ++j) {
    const std::size_t at = static_cast<std::size_t>(j);
    const Real inverse = f.inverse[at], below = f.below[at];  // below is 0 in the first row
    for_each_lane(0, nx_, [=, row = delta.row(j, k), before = delta.row(std::max(j - 1, 0), k)](int i) {
      row[i] = row[i] * inverse - below * before[i];
    });
  }
  for (int j = ny_ - 2; j >= 0; --j)
    for_each_lane(0, nx_,
                  [above = f.above[static_cast<std::size_t>(j)], row = delta.row(j, k),
                   after = delta.row(j + 1, k)](int i) { row[i] -= above * after[i]; });
}

void IncrementSmoother::smooth_z_and_add(FieldView delta, int j0, int j1, const Base& base) const {
  const Factors& f = factors_[2];
  for (int k = 0; active_[2] && k < nz_; ++k) {
    const std::size_t at = static_cast<std::size_t>(k);
    const Real inverse = f.inverse[at], below = f.below[at];
    for (int j = j0; j < j1; ++j)
      for_each_lane(0, nx_, [=, row = delta.row(j, k), before = delta.row(j, std::max(k - 1, 0))](int i) {
        row[i] = row[i] * inverse - below * before[i];
      });
  }
  // Backward; a row is added to its base as soon as the row below no longer needs it.
  for (int k = nz_ - 1; k >= 0; --k)
    for (int j = j0; j < j1; ++j) {
      Real* row = delta.row(j, k);
      const Real* two = base.two.row(j, k);
      const Real* one = base.a == Real(0) ? two : base.one.row(j, k);  // not needed: not fetched either
      const Real a = base.a, b = base.b, least = base.least;
      if (k > 0 && active_[2])
        for_each_lane(0, nx_,
                      [row, above = f.above[static_cast<std::size_t>(k - 1)],
                       below = delta.row(j, k - 1)](int i) { below[i] -= above * row[i]; });
      for_each_lane(0, nx_, [=](int i) {
        const Real sum = row[i] + a * one[i] + b * two[i];
        row[i] = sum < least ? least : sum;  // NaN stays
      });
    }
}

void IncrementSmoother::apply(FieldView delta, const Base& base) const {
  // Plane by plane, or as many of them at once as fill registers with rows
  const int together = ny_ > 1 ? 1 : kRealLanes;
  for_each_index((nz_ + together - 1) / together, [&](int n) {
    const int k0 = n * together, k1 = std::min(k0 + together, nz_);
    if (active_[1]) smooth_y(delta, k0);
    if (active_[0]) smooth_x(delta, k0 * ny_, k1 * ny_);
  });
  for_each_index((ny_ + kRowsTogether - 1) / kRowsTogether, [&](int n) {
    smooth_z_and_add(delta, n * kRowsTogether, std::min((n + 1) * kRowsTogether, ny_), base);
  });
}

}  // namespace ejecta
