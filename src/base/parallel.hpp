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

/// kernel(i) for i in [i0, i1) in SIMD on this thread, whole registers at a time: up to kLanes - 1 entries past
/// i1 are computed too. Rows of a Field, of Metrics and of scratch sized by whole registers have room for
/// them; what lands there is padding or ghosts that are filled again before they are read.
template <class Kernel>
inline void for_each_lane(int i0, int i1, const Kernel& kernel) {
  for (int i = i0; i < i1; i += kLanes) {
#pragma omp simd
    for (int lane = 0; lane < kLanes; ++lane) kernel(i + lane);
  }
}

/// kernel(i, j, k) for every cell; any order, no dependence between cells. Rows run as in for_each_lane.
template <class Kernel>
void for_each_cell(const Range3& r, const Kernel& kernel) {
#pragma omp parallel for schedule(static)
  for (int k = r.k0; k < r.k1; ++k)
    for (int j = r.j0; j < r.j1; ++j) for_each_lane(r.i0, r.i1, [&](int i) { kernel(i, j, k); });
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
#pragma omp parallel for schedule(dynamic, 16)
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

/// Largest kernel(i, j, k), at least `floor`. NaN propagates: a NaN anywhere gives NaN.
template <class Kernel>
Real reduce_max(const Range3& r, Real floor, const Kernel& kernel) {
  Real result = floor;
  bool nan = false;
#pragma omp parallel for schedule(static) reduction(max : result) reduction(|| : nan)
  for (int k = r.k0; k < r.k1; ++k)
    for (int j = r.j0; j < r.j1; ++j) {
      Real row = floor;
      int bad = 0;
#pragma omp simd reduction(max : row) reduction(| : bad)
      for (int i = r.i0; i < r.i1; ++i) {
        const Real v = kernel(i, j, k);
        row = v > row ? v : row;
        bad |= !(v == v);
      }
      result = row > result ? row : result;
      nan = nan || bad;
    }
  return nan ? std::numeric_limits<Real>::quiet_NaN() : result;
}

/// The three largest of kernel(i, j, k, a, b, c), which sets a, b and c, in one pass; at least 0. A NaN
/// anywhere is returned as NaN.
template <class Kernel>
std::array<Real, 3> reduce_max3(const Range3& r, const Kernel& kernel) {
  Real a = 0, b = 0, c = 0;
  bool nan = false;
#pragma omp parallel for schedule(static) reduction(max : a, b, c) reduction(|| : nan)
  for (int k = r.k0; k < r.k1; ++k)
    for (int j = r.j0; j < r.j1; ++j) {
      Real row_a = 0, row_b = 0, row_c = 0;
      int bad = 0;
#pragma omp simd reduction(max : row_a, row_b, row_c) reduction(| : bad)
      for (int i = r.i0; i < r.i1; ++i) {
        Real va, vb, vc;
        kernel(i, j, k, va, vb, vc);
        row_a = va > row_a ? va : row_a;
        row_b = vb > row_b ? vb : row_b;
        row_c = vc > row_c ? vc : row_c;
        bad |= !(va == va) | !(vb == vb) | !(vc == vc);
      }
      a = row_a > a ? row_a : a;
      b = row_b > b ? row_b : b;
      c = row_c > c ? row_c : c;
      nan = nan || bad;
    }
  if (nan) a = b = c = std::numeric_limits<Real>::quiet_NaN();
  return {a, b, c};
}

}  // namespace ejecta
