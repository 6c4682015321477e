#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

namespace ejecta {

/// What a grain whose drag is spread over a Gaussian of standard deviation sigma sees of the motion that this
/// drag makes, averaged with the same Gaussian, over the drag: s/kg. From the steady solution of the
/// equations of Oseen with a drag of other grains in them (Brinkman 1949),
///
///   u/f = (2 pi)^-3 integral of exp(-k^2 sigma^2) (1 - c^2) / (mu k^2 + rho D + i rho U k c) d3k
///
/// Stokes' part is 1 / (6 pi^1.5 mu sigma); 1 + 3/4 Re is its reduction by inertia within 3.5 % for any
/// Re = U sigma / nu (worked out numerically), and 2 D sigma^2 / nu the limit of strong drag by others.
/// slip: U, m/s; viscosity: nu, m2/s; drag: D, of the other grains over density and volume, 1/s.
EJECTA_KERNEL double own_wake(double sigma, double slip, double density, double viscosity, double drag) {
  const double inertia = 0.75 * slip * sigma / viscosity, others = 2 * drag * sigma * sigma / viscosity;
  return 1 / (6 * std::pow(std::numbers::pi, 1.5) * density * viscosity * sigma * (1 + inertia + others));
}

/// Beyond half of the slip the wake is not a correction any more.
inline constexpr double kMostWake = 0.5;

}  // namespace ejecta
