#pragma once
#include "flow/godunov/flux_hllc.hpp"

namespace ejecta::gas {

/// Pressure of a wall, difference to the reference, from the gas in its cell, of velocity `un` across it.
///
/// On the wall itself the normal velocity is known: none. So within the cell it falls from `un` to nothing,
/// and the wall has the pressure of its cell (no gradient of it stands on a plane wall), as far as the energy
/// of the cell can pay for a velocity that is uneven by `un`: rho un^2/2 <= p/(gamma - 1), the
/// positivity-preserving reconstruction of Zhang & Shu (2010, J. Comput. Phys. 229:8918). What is left of
/// `un` beyond, from Mach 1.9 on, meets its mirror image: HLLC's pressure, which for mirror images is HLL's.
EJECTA_KERNEL Real wall_pressure(const GasConstants& gas, Real rho, Real un, Real p) {
  const Real c2 = gas.sound_speed_squared(rho, p);
  const Real even = std::sqrt(2 * c2 / (gas.gamma * (gas.gamma - 1)));
  const Real left = un > even ? un - even : un < -even ? un + even : Real(0);
  const Real a = left + std::sqrt(c2), b = std::sqrt(c2 + Real(0.5) * left * left);  // Einfeldt
  return p + rho * left * (left - (a > b ? a : b));
}

/// Convection through the outermost faces of a grid, as a convection of FluxKernel: nothing but pressure
/// passes a wall, told by its ghost, the mirror image of the gas; the other faces are as inside. So is a
/// plane of symmetry, on which half a flow must be half of the whole.
struct WallConvection {
  template <int D, class P, class Kernel>
  EJECTA_KERNEL Flux flux(const Kernel& at, const Primitive& l, const Primitive& r,
                          const FaceSite& site) const {
    const bool lower = site.m == 0;
    const std::ptrdiff_t inside = lower ? site.o : site.o - site.s, beyond = lower ? site.o - site.s : site.o;
    const Real un = at.w.at(kU + D, inside);
    if (at.w.at(kU + D, beyond) != -un) return HllcConvection{}.template flux<D, P>(at, l, r, site);
    return {0, wall_pressure(at.gas, at.w.at(kRho, inside), lower ? un : -un, at.w.at(kP, inside)), 0, 0, 0};
  }
};

}  // namespace ejecta::gas
