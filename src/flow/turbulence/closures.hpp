#pragma once
#include <algorithm>
#include <cmath>

#include "base/real.hpp"

/// Two-equation closures as pure functions of one point. k in m2/s2, epsilon in m2/s3, omega in 1/s.
namespace ejecta {

/// Velocity gradient: xy = d u_x / d y, 1/s. Named members, not an array: the loops around must vectorise.
struct VelocityGradient {
  Real xx, xy, xz, yx, yy, yz, zx, zy, zz;
};

/// 2 S_ij S_ij, 1/s2, S the symmetric part of the gradient.
inline Real strain_squared(const VelocityGradient& v) {
  const Real xy = v.xy + v.yx, xz = v.xz + v.zx, yz = v.yz + v.zy;
  return Real(2) * (v.xx * v.xx + v.yy * v.yy + v.zz * v.zz) + xy * xy + xz * xz + yz * yz;
}

/// Pope's invariant of vortex stretching w_ij w_jk s_ki, without its factor (k / epsilon)^3: with S and W the
/// symmetric and antisymmetric parts of the gradient, W_ij W_jk S_ki, 1/s3 (Pope 1978, AIAA J. 16:279). Zero
/// in plane flow. With the vorticity w, W_ij W_jk = (w_i w_k - w^2 delta_ik) / 4, and S has no trace.
inline Real vortex_stretching(const VelocityGradient& v) {
  const Real x = v.zy - v.yz, y = v.xz - v.zx, z = v.yx - v.xy;
  return Real(0.25) * (x * x * v.xx + y * y * v.yy + z * z * v.zz + x * y * (v.xy + v.yx) +
                       x * z * (v.xz + v.zx) + y * z * (v.yz + v.zy));
}

/// nu_t / nu is limited to this (a jet of a sorter has about 1500), so that quotients of the ambient's
/// vanishing k and epsilon cannot set the time step.
inline constexpr Real kLargestViscosityRatio = Real(1e4);

/// Standard k-epsilon (Launder & Spalding 1974), with Pope's round-jet term.
namespace k_epsilon {
inline constexpr Real kCmu = Real(0.09), kC1 = Real(1.44), kC2 = Real(1.92), kC3 = Real(0.79);
inline constexpr Real kSigmaK = Real(1.0), kSigmaEpsilon = Real(1.3);

inline Real eddy_viscosity(Real k, Real epsilon, Real longest) {
  return kCmu * k * std::min(k / epsilon, longest);
}

/// Pope's term in the epsilon equation over epsilon^2 / k: C3 chi, chi = tau^3 W_ij W_jk S_ki, with tau the
/// turbulent time, s. Of vortices that are stretched alone: as a sink, where they are compressed, it grows
/// like 1 / epsilon, so that epsilon reaches zero after a finite time and k has no bound. That is the wake of
/// a body.
inline Real pope_gain(Real tau, Real stretching) {
  return kC3 * tau * tau * tau * std::max(stretching, Real(0));
}

/// The largest turbulent time scale whose eddy viscosity C_mu k tau leaves every normal stress positive,
/// tau <= 1 / (sqrt(3) C_mu sqrt(2 S_ij S_ij)) (Durbin 1996, with his factor at its bound): cures the false
/// turbulence at stagnation points; in a shear layer in equilibrium it is twice the model's own time and does
/// nothing.
inline Real longest_time(Real strain) {
  return Real(1) / (Real(1.7320508) * kCmu * std::max(strain, Real(1e-12)));
}
}  // namespace k_epsilon

/// k-omega SST (Menter 1994, NASA Turbulence Modeling Resource).
namespace k_omega_sst {
inline constexpr Real kSigmaK1 = Real(0.85), kSigmaW1 = Real(0.5), kBeta1 = Real(0.075);
inline constexpr Real kSigmaK2 = Real(1.0), kSigmaW2 = Real(0.856), kBeta2 = Real(0.0828);
inline constexpr Real kBetaStar = Real(0.09), kKappa = Real(0.41), kA1 = Real(0.31);

inline Real blend(Real f1, Real one, Real two) { return f1 * one + (Real(1) - f1) * two; }

/// gamma = beta / beta* - sigma_w kappa^2 / sqrt(beta*), of the inner and the outer set.
inline Real gamma(Real f1) {
  constexpr Real root = Real(0.3);
  constexpr Real one = kBeta1 / kBetaStar - kSigmaW1 * kKappa * kKappa / root;
  constexpr Real two = kBeta2 / kBetaStar - kSigmaW2 * kKappa * kKappa / root;
  return blend(f1, one, two);
}

/// Blending function F1; d is the distance to the nearest wall, m.
inline Real f1(Real k, Real omega, Real nu, Real d, Real cross) {
  const Real positive = std::max(cross, Real(1e-20));
  const Real inner = std::max(std::sqrt(k) / (kBetaStar * omega * d), Real(500) * nu / (d * d * omega));
  const Real arg = std::min(inner, Real(4) * kSigmaW2 * k / (positive * d * d));
  const Real arg2 = std::min(arg * arg, Real(10));
  return std::tanh(arg2 * arg2);
}

inline Real f2(Real k, Real omega, Real nu, Real d) {
  const Real arg =
      std::max(Real(2) * std::sqrt(k) / (kBetaStar * omega * d), Real(500) * nu / (d * d * omega));
  return std::tanh(std::min(arg * arg, Real(50)));
}

/// nu_t = a1 k / max(a1 omega, strain F2), strain = sqrt(2 S_ij S_ij).
inline Real eddy_viscosity(Real k, Real omega, Real strain, Real f2) {
  return kA1 * k / std::max(kA1 * omega, strain * f2);
}
}  // namespace k_omega_sst

}  // namespace ejecta
