#include "flow/poisson/small_gemm.hpp"

#include <cassert>

#include "base/simd.hpp"

namespace ejecta {
namespace {

/// kRows x (kVecs * kRealLanes) tile of C held in registers over the whole depth.
template <int kRows, int kVecs>
inline void tile(int depth, const Real* a, int lda, const Real* b, int ldb, Real* c, int ldc) {
  RealLanes sum[kRows][kVecs] = {};
  for (int d = 0; d < depth; ++d) {
    RealLanes row[kVecs];
    for (int v = 0; v < kVecs; ++v)
      row[v] = *reinterpret_cast<const RealLanes*>(b + d * ldb + v * kRealLanes);
    for (int r = 0; r < kRows; ++r) {
      const Real factor = a[r * lda + d];
      for (int v = 0; v < kVecs; ++v) sum[r][v] += factor * row[v];
    }
  }
  for (int r = 0; r < kRows; ++r)
    for (int v = 0; v < kVecs; ++v) *reinterpret_cast<RealLanes*>(c + r * ldc + v * kRealLanes) = sum[r][v];
}

template <int kVecs>
inline void columns(int m, int depth, const Real* a, int lda, const Real* b, int ldb, Real* c, int ldc) {
  constexpr int kRows = kVecs == 1 ? 14 : kVecs == 2 ? 12 : 8;
  int r = 0;
  for (; r + kRows <= m; r += kRows) tile<kRows, kVecs>(depth, a + r * lda, lda, b, ldb, c + r * ldc, ldc);
  for (; r + 4 <= m; r += 4) tile<4, kVecs>(depth, a + r * lda, lda, b, ldb, c + r * ldc, ldc);
  for (; r < m; ++r) tile<1, kVecs>(depth, a + r * lda, lda, b, ldb, c + r * ldc, ldc);
}

}  // namespace

void small_gemm(int m, int n, int depth, const Real* a, int lda, const Real* b, int ldb, Real* c, int ldc) {
  assert(n % kRealLanes == 0);
  int col = 0;
  for (; n - col >= 3 * kRealLanes; col += 3 * kRealLanes)
    columns<3>(m, depth, a, lda, b + col, ldb, c + col, ldc);
  if (n - col == 2 * kRealLanes) columns<2>(m, depth, a, lda, b + col, ldb, c + col, ldc);
  if (n - col == kRealLanes) columns<1>(m, depth, a, lda, b + col, ldb, c + col, ldc);
}

}  // namespace ejecta
