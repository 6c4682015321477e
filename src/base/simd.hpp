#pragma once
#include "base/real.hpp"

namespace ejecta {

/// One SIMD register of Reals (64 bytes; the compiler splits it where registers are shorter).
inline constexpr int kLanes = 64 / static_cast<int>(sizeof(Real));
using Lanes = Real __attribute__((vector_size(64), may_alias));
using LanesUnaligned = Real __attribute__((vector_size(64), may_alias, aligned(sizeof(Real))));

}  // namespace ejecta
