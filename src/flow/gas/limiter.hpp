#pragma once
#include <cmath>

#include "base/parallel.hpp"

/// Slope limiters: the slope in a cell from the slopes towards its two neighbours. Branch-free.
namespace ejecta::gas {

/// Harmonic mean, 2ab/(a+b) (van Leer 1974); smooth, second order away from extrema.
EJECTA_KERNEL Real limiter_van_leer(Real a, Real b) {
  const bool monotone = (a > 0) == (b > 0) && a != 0 && b != 0;
  return monotone ? 2 * a * (b / (a + b)) : Real(0);
}

/// Monotonised central: the mean, at most twice the smaller (van Leer 1977); sharper at contacts.
EJECTA_KERNEL Real limiter_monotonised_central(Real a, Real b) {
  const Real x = std::abs(a), y = std::abs(b);
  const Real smaller = 2 * (x < y ? x : y), mean = Real(0.5) * std::abs(a + b);
  const Real size = smaller < mean ? smaller : mean;
  return a * b > 0 ? std::copysign(size, a) : Real(0);
}

}  // namespace ejecta::gas
