#pragma once
#include <algorithm>
#include <cmath>

#include "base/real.hpp"

/// The law of the wall as pure functions of one point: what a wall does to the flow beside it. u is speed
/// along the wall relative to it (m/s), y the distance from it (m), nu kinematic viscosity (m2/s).
namespace ejecta::wall_law {

inline constexpr Real kKappa = Real(0.41), kE = Real(9.8);
inline constexpr Real kQuarterCmu = Real(0.5477226);  ///< 0.09^(1/4)

/// u+ at y+ of the viscous layer and the logarithm, joined where they meet; `rough` is the sand-grain height
/// over nu/u_tau: E/(1 + 0.3 k_s+) (Colebrook 1939, Grigson 1992), so that a smooth wall is k_s+ = 0. The 1
/// within the logarithm keeps it above 0 where grains leave no viscous layer; elsewhere it is lost in E y+.
inline Real u_plus(Real y_plus, Real rough) {
  const Real e = kE / (Real(1) + Real(0.3) * rough);
  const Real x = e * y_plus;
  return std::min(y_plus, (x > Real(0.1) ? std::log(Real(1) + x) : std::log1p(x)) / kKappa);  // log is faster
}

/// Friction velocity from the mean velocity alone.
inline Real friction_velocity(Real u, Real y, Real nu, Real roughness) {
  Real tau = std::sqrt(nu * u / y);
  for (int n = 0; n < 4; ++n) tau = u / std::max(u_plus(tau * y / nu, tau * roughness / nu), Real(1));
  return std::max(tau, std::sqrt(nu * u / y));
}

/// Shear stress over density and velocity, tau / (rho u), m/s. k is what turbulence there is beside the wall,
/// m2/s2 (Launder & Spalding 1974: u* = C_mu^(1/4) sqrt(k)); where it does not know of the shear yet the mean
/// velocity does.
inline Real conductance(Real u, Real y, Real nu, Real k, Real roughness) {
  const Real star = kQuarterCmu * std::sqrt(k), y_star = star * y / nu;
  const Real by_k = star / std::max(u_plus(y_star, star * roughness / nu), Real(1));
  const Real tau = friction_velocity(u, y, nu, roughness);
  const Real by_u = tau * tau / std::max(u, Real(1e-20));
  return std::max({by_k, u > Real(1e-20) ? by_u : Real(0), nu / y});
}

/// Whether a distance lies beyond the viscous layer of a wall with this k: turbulence is produced there.
inline bool beyond_viscous_layer(Real y, Real nu, Real k, Real roughness) {
  const Real star = kQuarterCmu * std::sqrt(k), y_star = star * y / nu;
  return u_plus(y_star, star * roughness / nu) < y_star;
}

/// Dissipation of k beside a wall where production balances it, m2/s3; inside the viscous layer its own
/// value.
inline Real dissipation(Real k, Real y, Real nu) {
  const Real star = kQuarterCmu * std::sqrt(k);
  return std::max(star * star * star / (kKappa * y), Real(2) * nu * k / (y * y));
}

/// omega beside a wall (Menter 1994), 1/s.
inline Real specific_dissipation(Real k, Real y, Real nu) {
  const Real viscous = Real(6) * nu / (Real(0.075) * y * y),
             log = kQuarterCmu * std::sqrt(k) / (Real(0.3) * kKappa * y);
  return std::sqrt(viscous * viscous + log * log);
}

}  // namespace ejecta::wall_law
