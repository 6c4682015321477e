#pragma once
#include <algorithm>
#include <array>
#include <cmath>
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

/// Cores this process may use.
int core_count();

/// Threads that share the loops the calling thread starts: all cores unless set. A thread that starts loops
/// has a team of its own; any number of threads, and any load of the machine, gives the same bits.
int thread_count();
void set_thread_count(int threads);

/// Numbers too small for full precision become zero on this thread: ahead of a wave fields fade through them,
/// and the processor is ten times slower there.
void flush_denormals();

namespace detail {
/// body(kernel, piece) for every piece, by the threads of the caller (base/team.hpp).
void run_pieces(int pieces, void (*body)(const void* kernel, int piece), const void* kernel);

/// kernel(piece, begin, end) for [0, count) cut into `pieces`.
template <class Kernel>
void for_each_piece(int count, int pieces, const Kernel& kernel) {
  struct Loop {
    int count, pieces;
    const Kernel& kernel;
  };
  const Loop loop{count, pieces, kernel};
  run_pieces(
      pieces,
      [](const void* context, int piece) {
        const Loop& l = *static_cast<const Loop*>(context);
        const auto edge = [&](int n) { return static_cast<int>(std::int64_t(l.count) * n / l.pieces); };
        l.kernel(piece, edge(piece), edge(piece + 1));
      },
      &loop);
}

/// Pieces for `count` entries of about equal cost: a thread that is behind leaves some of its own to others.
inline int even_pieces(int count) {
  constexpr int each = 8;
  const int threads = thread_count();
  return threads == 1 ? std::min(count, 1) : std::min(count, each * threads);
}
}  // namespace detail

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

/// kernel(i) for i in [i0, i1) in SIMD on this thread, and no further: any order, no dependence.
template <class Kernel>
inline void for_each_in_lanes(int i0, int i1, const Kernel& kernel) {
#pragma omp simd
  for (int i = i0; i < i1; ++i) kernel(i);
}

/// kernel(i, j, k) for every cell; any order, no dependence between cells. Rows run as in for_each_lane.
template <class Kernel>
void for_each_cell(const Range3& r, const Kernel& kernel) {
  const int planes = std::max(r.k1 - r.k0, 0);
  detail::for_each_piece(planes, detail::even_pieces(planes), [&](int, int begin, int end) {
    for (int k = r.k0 + begin; k < r.k0 + end; ++k)
      for (int j = r.j0; j < r.j1; ++j)
        for_each_lane(
            r.i0, r.i1, [&](int i) __attribute__((always_inline)) { kernel(i, j, k); });
  });
}

/// kernel(n) for n in [0, count), e.g. one plane, one row, one body at a time.
template <class Kernel>
void for_each_index(int count, const Kernel& kernel) {
  count = std::max(count, 0);
  detail::for_each_piece(count, detail::even_pieces(count), [&](int, int begin, int end) {
    for (int n = begin; n < end; ++n) kernel(n);
  });
}

/// kernel(begin, end) for a few contiguous chunks of [0, count) a thread: for sweeps that reuse what the
/// previous plane computed. The kernel's result must not depend on where chunks begin.
template <class Kernel>
void for_each_chunk(int count, const Kernel& kernel) {
  constexpr int each = 2, fewest = 8;  // a chunk computes the faces below its first plane once more
  const int threads = thread_count();
  const int chunks = threads == 1 ? 1 : std::max(threads, std::min(each * threads, count / fewest));
  detail::for_each_piece(count, std::min(chunks, count),
                         [&](int, int begin, int end) { kernel(begin, end); });
}

/// 64-byte aligned scratch of this thread, kept between calls; slot tells several buffers apart.
Real* thread_scratch(std::size_t count, int slot = 0);

/// As for_each_index, for iterations of very different cost.
template <class Kernel>
void for_each_index_dynamic(int count, const Kernel& kernel) {
  count = std::max(count, 0);
  detail::for_each_piece(count, count, [&](int n, int, int) { kernel(n); });
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
  for_each_index(r.k1 - r.k0, [&](int n) {
    const int k = r.k0 + n;
    double plane = 0.0;
    for (int j = r.j0; j < r.j1; ++j) {
      double row = 0.0;
#pragma omp simd reduction(+ : row)
      for (int i = r.i0; i < r.i1; ++i) row += static_cast<double>(kernel(i, j, k));
      plane += row;
    }
    planes[static_cast<std::size_t>(n)] = plane;
  });
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

  /// Of rate c; NaN where any rate was.
  double largest(std::size_t c) const {
    Real most = 0;
    for (int n = 0; n < kRealLanes; ++n) {
      if (nan[n]) return std::numeric_limits<double>::quiet_NaN();
      most = std::max(most, lane[c][n]);
    }
    return static_cast<double>(most);
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
  const int planes = std::max(r.k1 - r.k0, 0), pieces = detail::even_pieces(planes);
  std::vector<double>& largest = detail::partial_sums(pieces * static_cast<int>(kN));
  detail::for_each_piece(planes, pieces, [&](int piece, int begin, int end) {
    detail::Maxima<kN> m;
    for (int k = r.k0 + begin; k < r.k0 + end; ++k)
      for (int j = r.j0; j < r.j1; ++j) m.add_row(r.i0, r.i1, j, k, kernel);
    for (std::size_t c = 0; c < kN; ++c) largest[static_cast<std::size_t>(piece) * kN + c] = m.largest(c);
  });
  for (std::size_t n = 0; n < static_cast<std::size_t>(pieces) * kN; ++n) {
    if (std::isnan(largest[n])) {
      result.fill(std::numeric_limits<Real>::quiet_NaN());
      return result;
    }
    result[n % kN] = std::max(result[n % kN], static_cast<Real>(largest[n]));
  }
  return result;
}

/// The largest kernel(i, j, k), at least 0.
template <class Kernel>
Real reduce_max(const Range3& r, const Kernel& kernel) {
  return reduce_max<1>(
      r, [&](int i, int j, int k, Real* v) __attribute__((always_inline)) { v[0] = kernel(i, j, k); })[0];
}

}  // namespace ejecta
