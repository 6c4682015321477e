#pragma once
#include "base/real.hpp"

namespace ejecta {

/// C(m x n) = A(m x depth) B(depth x n), row-major. n must be a multiple of kRealLanes (base/simd.hpp) and
/// rows of B and C must be 64-byte aligned. Made for the transforms of the pressure solve: matrices of some
/// 100 x 100 that fit in L2, where a general BLAS spends its time on packing.
void small_gemm(int m, int n, int depth, const Real* a, int lda, const Real* b, int ldb, Real* c, int ldc);

}  // namespace ejecta
