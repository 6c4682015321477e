#pragma once
#include <utility>

#include "base/real.hpp"

namespace ejecta {

/// Loops over Reals run in blocks of this many, 64 bytes: a line of the cache, whole registers on every
/// processor.
inline constexpr int kRealLanes = 64 / static_cast<int>(sizeof(Real));

/// What one register of the processor holds. Kernels that keep data in registers are written in these: a
/// longer vector goes through memory at every operation.
#if defined(__AVX512F__)
inline constexpr int kRegisterBytes = 64;
#elif defined(__AVX__)
inline constexpr int kRegisterBytes = 32;
#else
inline constexpr int kRegisterBytes = 16;
#endif
inline constexpr int kRegisterLanes = kRegisterBytes / static_cast<int>(sizeof(Real));
using Register = Real __attribute__((vector_size(kRegisterBytes), may_alias));
/// The same at any address.
using LooseRegister = Real __attribute__((vector_size(kRegisterBytes), aligned(sizeof(Real)), may_alias));

namespace detail {
/// Swaps the off-diagonal quarters of every 2 kHalf x 2 kHalf block of the rows a (upper) and b (lower).
template <int kHalf, int... lane>
inline void swap_quarters(Register& a, Register& b, std::integer_sequence<int, lane...>) {
  const Register upper =
      __builtin_shufflevector(a, b, (lane & kHalf ? kRegisterLanes + lane - kHalf : lane)...);
  b = __builtin_shufflevector(a, b, (lane & kHalf ? kRegisterLanes + lane : lane + kHalf)...);
  a = upper;
}

template <int kHalf>
inline void transpose_from(Register (&m)[kRegisterLanes]) {
#pragma GCC unroll 16
  for (int row = 0; row < kRegisterLanes; ++row)
    if (!(row & kHalf))
      swap_quarters<kHalf>(m[row], m[row + kHalf], std::make_integer_sequence<int, kRegisterLanes>{});
  if constexpr (2 * kHalf < kRegisterLanes) transpose_from<2 * kHalf>(m);
}
}  // namespace detail

/// Transposes a square of kRegisterLanes registers.
inline void transpose(Register (&m)[kRegisterLanes]) { detail::transpose_from<1>(m); }

}  // namespace ejecta
