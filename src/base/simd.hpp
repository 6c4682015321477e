#pragma once
#include <utility>

#include "base/real.hpp"

namespace ejecta {

/// One SIMD register of Reals (64 bytes; the compiler splits it where registers are shorter).
inline constexpr int kRealLanes = 64 / static_cast<int>(sizeof(Real));
using RealLanes = Real __attribute__((vector_size(64), may_alias));
using RealLanesUnaligned = Real __attribute__((vector_size(64), may_alias, aligned(sizeof(Real))));

namespace detail {
/// Swaps the off-diagonal quarters of every 2 kHalf x 2 kHalf block of the rows a (upper) and b (lower).
template <int kHalf, int... lane>
inline void swap_quarters(RealLanes& a, RealLanes& b, std::integer_sequence<int, lane...>) {
  const RealLanes upper = __builtin_shufflevector(a, b, (lane & kHalf ? kRealLanes + lane - kHalf : lane)...);
  b = __builtin_shufflevector(a, b, (lane & kHalf ? kRealLanes + lane : lane + kHalf)...);
  a = upper;
}

template <int kHalf>
inline void transpose_from(RealLanes (&m)[kRealLanes]) {
#pragma GCC unroll 16
  for (int row = 0; row < kRealLanes; ++row)
    if (!(row & kHalf))
      swap_quarters<kHalf>(m[row], m[row + kHalf], std::make_integer_sequence<int, kRealLanes>{});
  if constexpr (2 * kHalf < kRealLanes) transpose_from<2 * kHalf>(m);
}
}  // namespace detail

/// Transposes a square of kRealLanes registers.
inline void transpose(RealLanes (&m)[kRealLanes]) { detail::transpose_from<1>(m); }

}  // namespace ejecta
