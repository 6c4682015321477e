#pragma once
#include <cmath>

/// Lets loops in SIMD call exp and log for a whole register at a time: the versions of glibc's libmvec (since
/// 2.22, within 4 units of the last digit), which its own headers declare only with -ffast-math. Elsewhere
/// the two stay what they are. A loop over a whole number of registers calls nothing else, so that a value
/// does not depend on its place in the loop.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__GLIBC__)
extern "C" {
__attribute__((simd("notinbranch"))) double exp(double) noexcept;
__attribute__((simd("notinbranch"))) double log(double) noexcept;
}
#endif
