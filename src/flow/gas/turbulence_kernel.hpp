#pragma once
#include <limits>

#include "flow/gas/geometry.hpp"
#include "flow/gas/state.hpp"
#include "flow/turbulence/closures.hpp"

namespace ejecta::gas {

/// What the sources of the turbulent quantities need of one point.
struct TurbulencePoint {
  VelocityGradient gradient;
  Real k, e;           ///< e: epsilon or omega
  Real strain2;        ///< 2 S_ij S_ij, 1/s2
  Real divergence;     ///< 1/s
  Real sound_squared;  ///< m2/s2
};

/// k and e after a step of the sources.
struct TurbulencePair {
  Real k, e;
};

/// Where div u comes from: of the velocity of the cells, or of that on the faces, -dp/(K dt) with K = gamma
/// p_ref + (gamma - 1) p', where a pressure equation has made it so. Beside a solid the former is wrong.
struct Dilatation {
  const Real* pressure_change = nullptr;  ///< Pa per cell; null: the former
  Real inv_dt = 0;                        ///< 1/s
};

/// Floors, far below any turbulence that matters.
inline constexpr Real kLeastK = Real(1e-8), kLeastE = Real(1e-8);

/// Extra dissipation of compressible turbulence: epsilon (1 + M_t^2), M_t^2 = 2k/c^2 (Sarkar, Erlebacher,
/// Hussaini & Kreiss 1991, J. Fluid Mech. 227:473, alpha_1 = 1).
EJECTA_KERNEL Real dilatation_dissipation(Real k, Real sound_squared) { return 1 + 2 * k / sound_squared; }

/// Time scale of k-epsilon: k/epsilon, at most that for which the normal stresses stay positive, nu_t = C_mu
/// k T <= k/(sqrt(6) |S|), |S|^2 = S_ij S_ij (Durbin 1996, Int. J. Heat Fluid Flow 17:89, with the bound
/// itself). Only rapid strain meets it: shocks, and still air overrun by the head of a jet.
EJECTA_KERNEL Real realizable_time(Real k, Real epsilon, Real strain2) {
  const Real turnover = k / epsilon;
  const Real bound = 1 / (k_epsilon::kCmu * std::sqrt(3 * strain2) + Real(1e-20));
  return turnover < bound ? turnover : bound;
}

/// Production of k per mass: nu_t (2 S_ij S_ij - 2/3 (div u)^2) - 2/3 k div u, m2/s3. The last term may be a
/// sink.
struct Production {
  Real strain, dilatation;
};
EJECTA_KERNEL Production production(const TurbulencePoint& p, Real nu_t) {
  const Real strain = p.strain2 - Real(2.0 / 3.0) * p.divergence * p.divergence;
  return {nu_t * (strain > 0 ? strain : Real(0)), Real(-2.0 / 3.0) * p.divergence};
}

EJECTA_KERNEL Real positive(Real a) { return a > 0 ? a : Real(0); }

/// Sources of k-epsilon over dt, sinks implicit so that both stay positive.
/// `bounded`: the time scale of the equation of epsilon is bounded like that of the eddy viscosity (Durbin
/// 1996), without which k grows for as long as gas stays in the shear beside a body.
EJECTA_KERNEL TurbulencePair advance_k_epsilon(const TurbulencePoint& p, Real dt, bool round_jet,
                                               bool compressible, bool bounded) {
  using namespace k_epsilon;
  const Real time = realizable_time(p.k, p.e, p.strain2);
  const Production made = production(p, kCmu * p.k * time);
  const Real rate = p.e / p.k, loss = compressible ? dilatation_dissipation(p.k, p.sound_squared) : Real(1);
  const Real gain = made.strain + positive(made.dilatation) * p.k, lost = positive(-made.dilatation);
  const Real own = bounded ? 1 / time : rate;
  const Real pope = round_jet ? pope_gain(time, vortex_stretching(p.gradient)) : Real(0);
  return {(p.k + dt * gain) / (1 + dt * (rate * loss + lost)),
          (p.e + dt * own * (kC1 * gain + pope * p.e)) / (1 + dt * (own * kC2 + kC1 * lost))};
}

/// Sources of k-omega SST over dt; `cross` is (1 - F1) times the cross-diffusion, 1/s2.
EJECTA_KERNEL TurbulencePair advance_k_omega_sst(const TurbulencePoint& p, Real nu_t, Real f1, Real cross,
                                                 Real dt, bool compressible) {
  using namespace k_omega_sst;
  const Production made = production(p, nu_t);
  const Real most = Real(20) * kBetaStar * p.k * p.e;
  const Real produced = made.strain < most ? made.strain : most;
  // omega's share of the dilatation dissipation (Wilcox 2006, section 5.5): what k loses more, omega loses
  // less
  const Real loss = compressible ? dilatation_dissipation(p.k, p.sound_squared) : Real(1);
  const Real beta = k_omega_sst::blend(f1, kBeta1, kBeta2);
  const Real gain = positive(made.dilatation), lost = positive(-made.dilatation);
  return {(p.k + dt * (produced + gain * p.k)) / (1 + dt * (kBetaStar * p.e * loss + lost)),
          (p.e + dt * (gamma(f1) * produced / (nu_t + Real(1e-20)) + positive(cross))) /
              (1 + dt * (positive(beta - kBetaStar * (loss - 1)) * p.e + positive(-cross) / p.e))};
}

/// Sources of the turbulent quantities over dt, and the eddy viscosity (Pa s) that follows. Writes to blocks
/// of its own: the neighbours' gradients still read `w`.
template <bool Sst, bool RoundJet, bool Across>
struct TurbulenceKernel {
  BlockView<const Real> w;
  BlockView<Real> next, u;  ///< primitive and conserved k and e
  Real* eddy_viscosity;
  Real* f1;                                  ///< blending function of SST, 1 near walls
  std::array<const Real*, 3> wall_distance;  ///< to the nearest wall across each axis, m
  ConstFieldView solid_distance;             ///< SST: to the nearest solid near by, m
  GasConstants gas;
  std::array<AxisLengths, 3> axis;
  Real viscosity, dt;
  bool compressible;
  Dilatation dilatation;

  EJECTA_KERNEL Real derivative(int c, int d, std::ptrdiff_t o, std::ptrdiff_t s, int index) const {
    const Real* v = w.origin[static_cast<std::size_t>(c)] + o;
    return (v[s] - v[-s]) * axis[static_cast<std::size_t>(d)].inv_span[index];
  }

  EJECTA_KERNEL VelocityGradient gradient(int i, int j, int k, std::ptrdiff_t o) const {
    VelocityGradient v{};
    v.xx = derivative(kU, 0, o, 1, i);
    v.xz = derivative(kU, 2, o, w.sz, k);
    v.zx = derivative(kW, 0, o, 1, i);
    v.zz = derivative(kW, 2, o, w.sz, k);
    v.yy = w.at(kU, o) * axis[0].inv_radius_centre[i];  // the hoop; 0 in Cartesian geometry
    if constexpr (Across) {
      v.xy = derivative(kU, 1, o, w.sy, j);
      v.yx = derivative(kV, 0, o, 1, i);
      v.yy += derivative(kV, 1, o, w.sy, j);
      v.yz = derivative(kV, 2, o, w.sz, k);
      v.zy = derivative(kW, 1, o, w.sy, j);
    }
    return v;
  }

  /// grad k . grad omega / omega, 1/s2. omega of each direction is the mean of the neighbours that make the
  /// difference: where it jumps by orders of magnitude, at the edge of a starting jet, the quotient stays
  /// within 1/h.
  EJECTA_KERNEL Real gradient_product(int i, int j, int k, std::ptrdiff_t o) const {
    const Real* omega = w.origin[kE] + o;
    const auto along = [&](int d, std::ptrdiff_t s, int at) __attribute__((always_inline)) {
      const Real mean = Real(0.5) * (omega[s] + omega[-s]);
      return derivative(kK, d, o, s, at) * derivative(kE, d, o, s, at) / (mean > kLeastE ? mean : kLeastE);
    };
    Real sum = along(0, 1, i) + along(2, w.sz, k);
    if constexpr (Across) sum += along(1, w.sy, j);
    return sum;
  }

  EJECTA_KERNEL void operator()(int i, int j, int k) const {
    const std::ptrdiff_t o = w.offset(i, j, k);
    const Real rho = w.at(kRho, o), inv = 1 / rho;
    TurbulencePoint p;
    p.gradient = gradient(i, j, k, o);
    p.k = w.at(kK, o) > kLeastK ? w.at(kK, o) : kLeastK;
    p.e = w.at(kE, o) > kLeastE ? w.at(kE, o) : kLeastE;
    p.strain2 = strain_squared(p.gradient);
    const Real stiffness = gas.gamma * gas.reference_pressure + (gas.gamma - 1) * w.at(kP, o);
    p.divergence = dilatation.pressure_change ? -dilatation.pressure_change[o] * dilatation.inv_dt / stiffness
                                              : p.gradient.xx + p.gradient.yy + p.gradient.zz;
    p.sound_squared = gas.sound_speed_squared(rho, w.at(kP, o));
    TurbulencePair after;
    Real mut;
    if constexpr (Sst) {
      using namespace k_omega_sst;
      Real d = wall_distance[0][i] < wall_distance[1][j] ? wall_distance[0][i] : wall_distance[1][j];
      d = wall_distance[2][k] < d ? wall_distance[2][k] : d;
      d = solid_distance(i, j, k) < d ? solid_distance(i, j, k) : d;
      const Real nu = viscosity * inv, cross = 2 * kSigmaW2 * gradient_product(i, j, k, o);
      const Real blending = k_omega_sst::f1(p.k, p.e, nu, d, cross);
      after =
          advance_k_omega_sst(p, eddy_viscosity[o] * inv, blending, (1 - blending) * cross, dt, compressible);
      f1[o] = blending;
      mut = rho *
            k_omega_sst::eddy_viscosity(after.k, after.e, std::sqrt(p.strain2), f2(after.k, after.e, nu, d));
    } else {
      after = advance_k_epsilon(p, dt, RoundJet, compressible, dilatation.pressure_change != nullptr);
      mut = rho * k_epsilon::kCmu * after.k * realizable_time(after.k, after.e, p.strain2);
    }
    const Real most = kLargestViscosityRatio * viscosity;
    eddy_viscosity[o] = mut < most ? mut : most;
    next.at(kK, o) = after.k;
    next.at(kE, o) = after.e;
    u.at(kK, o) = rho * after.k;
    u.at(kE, o) = rho * after.e;
  }
};

}  // namespace ejecta::gas
