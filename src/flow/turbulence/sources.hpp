#pragma once
#include <algorithm>
#include <cmath>

#include "flow/stencil.hpp"
#include "flow/turbulence/closures.hpp"

namespace ejecta {

inline constexpr Real kMinimalK = kLeastPositive, kMinimalDissipation = kLeastPositive;

/// What the sources of one cell need.
struct SourcePoint {
  Real k, dissipation;                  ///< at the beginning of the step
  Real k_carried, dissipation_carried;  ///< after what passed its faces
  Real strain2;                         ///< 2 S_ij S_ij, 1/s2
  Real produced;                        ///< of k, m2/s3
  Real eddy_viscosity;                  ///< m2/s
  Real stretching;                      ///< Pope's invariant, 1/s3; k-epsilon alone
  Real f1, gradients;                   ///< SST alone: blending, grad k . grad omega / omega
};

/// k and epsilon (or omega) after the sources of a step dt, sinks implicit; still to be kept positive, as
/// what diffused out of the cell is explicit.
struct SourceResult {
  Real k, dissipation;
};
template <bool kSst, bool kRound>
EJECTA_KERNEL SourceResult advance_sources(const SourcePoint& p, Real dt) {
  Real k1, s1;
  if constexpr (kSst) {
    using namespace k_omega_sst;
    const Real beta = blend(p.f1, kBeta1, kBeta2), most = Real(20) * kBetaStar * p.k * p.dissipation;
    const Real cross = (Real(1) - p.f1) * Real(2) * kSigmaW2 * p.gradients;
    const Real gain = gamma(p.f1) * std::min(p.strain2, most / std::max(p.eddy_viscosity, Real(1e-12))) +
                      std::max(cross, Real(0));
    k1 = (p.k_carried + dt * std::min(p.produced, most)) / (Real(1) + dt * kBetaStar * p.dissipation);
    s1 = (p.dissipation_carried + dt * gain) /
         (Real(1) + dt * (beta * p.dissipation + std::max(-cross, Real(0)) / p.dissipation));
  } else {
    using namespace k_epsilon;
    const Real longest = longest_time(std::sqrt(p.strain2));
    const Real rate = p.dissipation / p.k, own_rate = std::max(rate, Real(1) / longest);
    Real gain = kC1 * p.produced;
    if constexpr (kRound)
      gain += pope_gain(std::min(p.k / p.dissipation, longest), p.stretching) * p.dissipation;
    k1 = (p.k_carried + dt * p.produced) / (Real(1) + dt * rate);
    s1 = (p.dissipation_carried + dt * own_rate * gain) / (Real(1) + dt * kC2 * own_rate);
  }
  return {k1, s1};
}

}  // namespace ejecta
