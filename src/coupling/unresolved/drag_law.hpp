#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.hpp"
#include "base/vector_math.hpp"

/// Drag of a sphere among others as pure functions. All return beta, kg/s, of f_d = beta (u - v): the force
/// on one grain as it stands in the momentum equation of model A (Zhou et al. 2010, J. Fluid Mech. 661:482),
/// in which the gradient of the pressure acts on the grain besides. Nothing is divided by zero at rest. No
/// branch calls a function: they run on several grains at once (grain_drag.hpp).
namespace ejecta::drag {

/// A grain and the fluid around it. e: part of the volume that is fluid, 0 < e <= 1.
struct Surroundings {
  double diameter = 0;   ///< m
  double slip = 0;       ///< |u - v|, m/s
  double fraction = 1;   ///< e
  double density = 0;    ///< of the fluid, kg/m3
  double viscosity = 0;  ///< of the fluid, m2/s, kinematic

  /// With the superficial slip, e d |u - v| / nu
  EJECTA_KERNEL double reynolds() const { return fraction * diameter * slip / viscosity; }
  /// m3
  EJECTA_KERNEL double volume() const { return std::numbers::pi / 6 * diameter * diameter * diameter; }
  EJECTA_KERNEL double dynamic_viscosity() const { return density * viscosity; }  ///< Pa s
};

/// base^exponent, base > 0
EJECTA_KERNEL double power(double base, double exponent) { return std::exp(exponent * std::log(base)); }

/// 1 + 0.15 Re^0.687, at most what it is at Re 1000
EJECTA_KERNEL double schiller_naumann_factor(double re) {
  constexpr double kLeast = 1e-300;
  return 1 + 0.15 * power(std::clamp(re, kLeast, 1000.0), 0.687);
}

/// 3 pi mu d (Stokes 1851): linear, for Re << 1.
EJECTA_KERNEL double stokes(const Surroundings& s) {
  return 3 * std::numbers::pi * s.dynamic_viscosity() * s.diameter;
}

/// Schiller & Naumann (1935, VDI-Z. 77:318): C_D = 24 (1 + 0.15 Re^0.687) / Re, 0.44 above Re 1000; one
/// grain alone, e plays no part.
EJECTA_KERNEL double schiller_naumann(const Surroundings& s) {
  const double re = s.diameter * s.slip / s.viscosity, fast = 0.44 * re / 24;
  return stokes(s) * (re > 1000 ? fast : schiller_naumann_factor(re));
}

/// (pi/8) d^2 rho |u - v| (0.63 + 4.8 / sqrt(Re))^2 with Re not 0 nor the slip: what Di Felice and Rong
/// share. Written so that it is finite at rest: C_D Re = (0.63 sqrt(Re) + 4.8)^2.
EJECTA_KERNEL double dalla_valle(const Surroundings& s) {
  const double root = 0.63 * std::sqrt(s.reynolds()) + 4.8;
  return std::numbers::pi / 8 * s.diameter * s.dynamic_viscosity() / s.fraction * root * root;
}

/// exp(-(1.5 - log10 Re)^2 / 2), 0 at rest
EJECTA_KERNEL double bell(double re) {
  constexpr double kLeast = 1e-300;  // where nothing is left of it
  const double x = 1.5 - std::numbers::log10e * std::log(std::max(re, kLeast));
  return std::exp(-0.5 * x * x);
}

/// Di Felice (1994, Int. J. Multiphase Flow 20:153), the paper's: e^(2 - chi) of the drag alone at the same
/// superficial slip, chi = 3.7 - 0.65 exp(-(1.5 - log10 Re)^2 / 2). The 2 - chi is model A's: model B has
/// 1 - chi.
EJECTA_KERNEL double di_felice(const Surroundings& s) {
  const double chi = 3.7 - 0.65 * bell(s.reynolds());
  return dalla_valle(s) * power(s.fraction, 2 - chi);
}

/// Rong, Dong & Yu (2013, Chem. Eng. Sci. 99:44): as Di Felice with
/// chi = 2.65 (e + 1) - (5.3 - 3.5 e) e^2 exp(-(1.5 - log10 Re)^2 / 2).
EJECTA_KERNEL double rong(const Surroundings& s) {
  const double e = s.fraction;
  const double chi = 2.65 * (e + 1) - (5.3 - 3.5 * e) * e * e * bell(s.reynolds());
  return dalla_valle(s) * power(e, 2 - chi);
}

/// Koch & Hill (2001, Annu. Rev. Fluid Mech. 33:619; as used by Benyahia et al. 2006):
/// V_p 18 mu e F / d^2, F = e (F0 + F3 Re / 2).
EJECTA_KERNEL double koch_hill(const Surroundings& s) {
  const double e = s.fraction, p = 1 - e, cube = e * e * e;
  constexpr double kLeast = 1e-300;
  const double thin =
      (1 + 3 * std::sqrt(std::max(p, 0.0) / 2) + 135.0 / 64 * p * std::log(std::max(p, kLeast)) + 16.14 * p) /
      (1 + 0.681 * p - 8.48 * p * p + 8.16 * p * p * p);
  const double f0 = p < 0.4 ? thin : 10 * p / cube;
  const double f3 = 0.0673 + 0.212 * p + 0.0232 / (cube * e * e);
  const double f = e * (f0 + 0.5 * f3 * s.reynolds());
  return s.volume() * 18 * s.dynamic_viscosity() * e * f / (s.diameter * s.diameter);
}

/// Gidaspow (1994): Ergun (1952) where e < 0.8, Wen & Yu (1966) else; it jumps there.
EJECTA_KERNEL double gidaspow(const Surroundings& s) {
  const double e = s.fraction, p = 1 - e, d = s.diameter, re = s.reynolds();
  const double ergun = 150 * p * s.dynamic_viscosity() / (e * d * d) + 1.75 * s.density * s.slip / d;
  const double fast = 0.44 * re, slow = 24 * schiller_naumann_factor(re);  // C_D Re
  const double wen_yu = 0.75 * (re > 1000 ? fast : slow) * s.dynamic_viscosity() * power(e, -2.65) / (d * d);
  return s.volume() * (e < 0.8 ? ergun : wen_yu);  // beta of the volume over its solids
}

}  // namespace ejecta::drag
