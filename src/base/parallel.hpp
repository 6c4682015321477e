#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "base/simd.hpp"

/// The only place that knows how loops run. A kernel is a small functor over plain views: no allocation,
/// no virtual call, no container inside. Loops run over planes of constant k in parallel and over i in SIMD.
namespace ejecta {

/// Put before a kernel's call operator and the functions it calls: a loop is only vectorised when all of its
/// body is inlined, which the compiler declines for large kernels.
#define EJECTA_KERNEL [[gnu::always_inline]] inline

/// Half-open index box [i0,i1) x [j0,j1) x [k0,k1).
struct Range3 {
  int i0 = 0, i1 = 0, j0 = 0, j1 = 0, k0 = 0, k1 = 0;
};

int thread_count();
void set_thread_count(int threads);

/// kernel(i) for i in [i0, i1) in SIMD on this thread, whole registers at a time: up to kRealLanes - 1
/// entries past i1 are computed too. Rows of a Field, of Metrics and of scratch sized by whole registers have
/// room for them; what lands there is padding or ghosts that are filled again before they are read.
template <class Kernel>
inline void for_each_lane(int i0, int i1, const Kernel& kernel) {
  if (i1 == i0 + 1) return kernel(i0);  // a column of faces; one cell in x
  for (int i = i0; i < i1; i += kRealLanes) {
#pragma omp simd
    for (int lane = 0; lane < kRealLanes; ++lane) kernel(i + lane);
  }
}

/// kernel(i, j, k) for every cell; any order, no dependence between cells. Rows run as in for_each_lane.
template <class Kernel>
void for_each_cell(const Range3& r, const Kernel& kernel) {
#pragma omp parallel for schedule(static)
  for (int k = r.k0; k < r.k1; ++k)
    for (int j = r.j0; j < r.j1; ++j)
      for_each_lane(
          r.i0, r.i1, [&](int i) __attribute__((always_inline)) { kernel(i, j, k); });
}

/// kernel(n) for n in [0, count), e.g. one plane, one row, one body at a time.
template <class Kernel>
void for_each_index(int count, const Kernel& kernel) {
#pragma omp parallel for schedule(static)
  for (int n = 0; n < count; ++n) kernel(n);
}

/// kernel(begin, end) for one contiguous chunk of [0, count) a thread: for sweeps that reuse what the
/// previous plane computed. The kernel's result must not depend on where chunks begin.
template <class Kernel>
void for_each_chunk(int count, const Kernel& kernel) {
  const int chunks = thread_count() < count ? thread_count() : count;
#pragma omp parallel for schedule(static)
  for (int c = 0; c < chunks; ++c)
    kernel(static_cast<int>(std::int64_t(count) * c / chunks),
           static_cast<int>(std::int64_t(count) * (c + 1) / chunks));
}

/// 64-byte aligned scratch of this thread, kept between calls; slot tells several buffers apart.
Real* thread_scratch(std::size_t count, int slot = 0);

/// As for_each_index, for iterations of very different cost.
template <class Kernel>
void for_each_index_dynamic(int count, const Kernel& kernel) {
#pragma omp parallel for schedule(dynamic, 2)
  for (int n = 0; n < count; ++n) kernel(n);
}

namespace detail {
std::vector<double>& partial_sums(int count);  // scratch kept between calls: a step allocates nothing
}

/// Sum of kernel(i, j, k) in double. Every row is summed in SIMD lanes of fixed width, rows and planes in
/// order: the same bits for any number of threads.
template <class Kernel>
double reduce_sum(const Range3& r, const Kernel& kernel) {
  if (r.k1 <= r.k0) return 0.0;
  std::vector<double>& planes = detail::partial_sums(r.k1 - r.k0);
#pragma omp parallel for schedule(static)
  for (int k = r.k0; k < r.k1; ++k) {
    double plane = 0.0;
    for (int j = r.j0; j < r.j1; ++j) {
      double row = 0.0;
#pragma omp simd reduction(+ : row)
      for (int i = r.i0; i < r.i1; ++i) row += static_cast<double>(kernel(i, j, k));
      plane += row;
    }
    planes[static_cast<std::size_t>(k - r.k0)] = plane;
  }
  double sum = 0.0;
  for (int n = 0; n < r.k1 - r.k0; ++n) sum += planes[static_cast<std::size_t>(n)];
  return sum;
}

namespace detail {
/// Running maxima of kN rates in SIMD lanes; remembers whether a NaN was seen.
template <std::size_t kN>
struct Maxima {
  Real lane[kN][kRealLanes] = {};
  int nan[kRealLanes] = {};

  template <class Kernel>
  EJECTA_KERNEL void add(int n, int i, int j, int k, const Kernel& kernel) {
    Real v[kN];
    kernel(i, j, k, v);
    for (std::size_t c = 0; c < kN; ++c) {
      lane[c][n] = v[c] > lane[c][n] ? v[c] : lane[c][n];
      nan[n] |= !(v[c] == v[c]);
    }
  }

  /// One row; where registers do not divide it the last one overlaps the one before.
  template <class Kernel>
  void add_row(int i0, int i1, int j, int k, const Kernel& kernel) {
    for (int i = i0; i1 - i0 < kRealLanes && i < i1; ++i) add(0, i, j, k, kernel);
    for (int i = i0; i1 - i0 >= kRealLanes && i < i1; i += kRealLanes) {
      const int start = i + kRealLanes <= i1 ? i : i1 - kRealLanes;
#pragma omp simd
      for (int n = 0; n < kRealLanes; ++n) add(n, start + n, j, k, kernel);
    }
  }
};
}  // namespace detail

/// The largest of each of the kN values that kernel(i, j, k, values) sets, at least 0, in one pass. A NaN
/// anywhere is returned as NaN.
template <std::size_t kN, class Kernel>
std::array<Real, kN> reduce_max(const Range3& r, const Kernel& kernel) {
  std::array<Real, kN> result{};
  bool nan = false;
#pragma omp parallel
  {
    detail::Maxima<kN> m;
#pragma omp for schedule(static) nowait
    for (int k = r.k0; k < r.k1; ++k)
      for (int j = r.j0; j < r.j1; ++j) m.add_row(r.i0, r.i1, j, k, kernel);
#pragma omp critical(ejecta_reduce_max)
    for (int n = 0; n < kRealLanes; ++n) {
      nan = nan || m.nan[n];
      for (std::size_t c = 0; c < kN; ++c) result[c] = m.lane[c][n] > result[c] ? m.lane[c][n] : result[c];
    }
  }
  if (nan) result.fill(std::numeric_limits<Real>::quiet_NaN());
  return result;
}

/// The largest kernel(i, j, k), at least 0.
template <class Kernel>
Real reduce_max(const Range3& r, const Kernel& kernel) {
  return reduce_max<1>(
      r, [&](int i, int j, int k, Real* v) __attribute__((always_inline)) { v[0] = kernel(i, j, k); })[0];
}

}  // namespace ejecta
