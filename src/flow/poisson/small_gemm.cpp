#include "flow/poisson/small_gemm.hpp"

#include <cassert>

#include "base/simd.hpp"

namespace ejecta {
namespace {

/// The tile of C that registers hold beside two or three of B and a factor: 24 of the 32 of AVX-512, 12 of
/// the 16 of AVX and SSE.
inline constexpr int kTileRows = kRegisterBytes == 64 ? 8 : 6, kTileRegisters = kRegisterBytes == 64 ? 3 : 2;

/// kRows x (kRegisters * kRegisterLanes) tile of C held in registers over the whole depth.
template <int kRows, int kRegisters>
inline void tile(int depth, const Real* a, int lda, const Real* b, int ldb, Real* c, int ldc) {
  Register sum[kRows][kRegisters] = {};
  for (int d = 0; d < depth; ++d) {
    Register row[kRegisters];
    for (int v = 0; v < kRegisters; ++v)
      row[v] = *reinterpret_cast<const Register*>(b + d * ldb + v * kRegisterLanes);
    for (int r = 0; r < kRows; ++r) {
      const Real factor = a[r * lda + d];
      for (int v = 0; v < kRegisters; ++v) sum[r][v] += factor * row[v];
    }
  }
  for (int r = 0; r < kRows; ++r)
    for (int v = 0; v < kRegisters; ++v)
      *reinterpret_cast<Register*>(c + r * ldc + v * kRegisterLanes) = sum[r][v];
}

template <int kRegisters>
inline void columns(int m, int depth, const Real* a, int lda, const Real* b, int ldb, Real* c, int ldc) {
  constexpr int kRows = kTileRows * kTileRegisters / kRegisters;
  int r = 0;
  for (; r + kRows <= m; r += kRows)
    tile<kRows, kRegisters>(depth, a + r * lda, lda, b, ldb, c + r * ldc, ldc);
  for (; r + 4 <= m; r += 4) tile<4, kRegisters>(depth, a + r * lda, lda, b, ldb, c + r * ldc, ldc);
  for (; r < m; ++r) tile<1, kRegisters>(depth, a + r * lda, lda, b, ldb, c + r * ldc, ldc);
}

}  // namespace

void small_gemm(int m, int n, int depth, const Real* a, int lda, const Real* b, int ldb, Real* c, int ldc) {
  assert(n % kRealLanes == 0);
  int col = 0;
  for (; n - col >= kTileRegisters * kRegisterLanes; col += kTileRegisters * kRegisterLanes)
    columns<kTileRegisters>(m, depth, a, lda, b + col, ldb, c + col, ldc);
  if (n - col == 2 * kRegisterLanes) columns<2>(m, depth, a, lda, b + col, ldb, c + col, ldc);
  if (n - col == kRegisterLanes) columns<1>(m, depth, a, lda, b + col, ldb, c + col, ldc);
}

}  // namespace ejecta
