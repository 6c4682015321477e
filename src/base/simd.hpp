#pragma once
#include <utility>

#include "base/real.hpp"

namespace ejecta {

/// One SIMD register of Reals (64 bytes; the compiler splits it where registers are shorter).
inline constexpr int kLanes = 64 / static_cast<int>(sizeof(Real));
using Lanes = Real __attribute__((vector_size(64), may_alias));
using LanesUnaligned = Real __attribute__((vector_size(64), may_alias, aligned(sizeof(Real))));

namespace detail {
/// Swaps the off-diagonal quarters of every 2 kHalf x 2 kHalf block of the rows a (upper) and b (lower).
template <int kHalf, int... lane>
inline void swap_quarters(Lanes& a, Lanes& b, std::integer_sequence<int, lane...>) {
  const Lanes upper = __builtin_shufflevector(a, b, (lane & kHalf ? kLanes + lane - kHalf : lane)...);
  b = __builtin_shufflevector(a, b, (lane & kHalf ? kLanes + lane : lane + kHalf)...);
  a = upper;
}

template <int kHalf>
inline void transpose_from(Lanes (&m)[kLanes]) {
#pragma GCC unroll 16
  for (int row = 0; row < kLanes; ++row)
    if (!(row & kHalf))
      swap_quarters<kHalf>(m[row], m[row + kHalf], std::make_integer_sequence<int, kLanes>{});
  if constexpr (2 * kHalf < kLanes) transpose_from<2 * kHalf>(m);
}
}  // namespace detail

/// Transposes a square of kLanes registers.
inline void transpose(Lanes (&m)[kLanes]) { detail::transpose_from<1>(m); }

}  // namespace ejecta
