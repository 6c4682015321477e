#pragma once
#include <cmath>

#include "flow/gas/flux_kernel.hpp"

/// Riemann solvers as pure functions of two states. Written so that two equal states at rest give a flux of
/// exactly zero (momentum is counted from the reference pressure).
namespace ejecta::gas {

/// Speeds of the outer waves and of the contact between two states.
struct WaveSpeeds {
  Real left, right, contact, pressure;  ///< `pressure` of the star region, difference to the reference
};

EJECTA_KERNEL Real energy(const GasConstants& gas, const Primitive& w) {
  return w.p * gas.inv_gamma_minus_1 + Real(0.5) * w.rho * (w.un * w.un + w.ut * w.ut + w.us * w.us);
}

/// Einfeldt (1988) for the outer waves, which keeps density and pressure positive (Batten et al. 1997, SIAM
/// J. Sci. Comput. 18:1553); contact speed of Toro, Riemann Solvers, eq. 10.37.
EJECTA_KERNEL WaveSpeeds wave_speeds_einfeldt(const GasConstants& gas, const Primitive& l,
                                              const Primitive& r) {
  const Real rl = std::sqrt(l.rho), rr = std::sqrt(r.rho), inv = 1 / (rl + rr);
  const Real c2l = gas.sound_speed_squared(l.rho, l.p), c2r = gas.sound_speed_squared(r.rho, r.p);
  const Real jump = r.un - l.un;
  const Real mean = (rl * l.un + rr * r.un) * inv;
  const Real c = std::sqrt((rl * c2l + rr * c2r) * inv + Real(0.5) * rl * rr * inv * inv * jump * jump);
  const Real sl1 = l.un - std::sqrt(c2l), sl2 = mean - c;
  const Real sr1 = r.un + std::sqrt(c2r), sr2 = mean + c;
  WaveSpeeds s;
  s.left = sl1 < sl2 ? sl1 : sl2;
  s.right = sr1 > sr2 ? sr1 : sr2;
  const Real ml = l.rho * (s.left - l.un), mr = r.rho * (s.right - r.un), difference = 1 / (mr - ml);
  s.contact = (l.p - r.p + mr * r.un - ml * l.un) * difference;
  s.pressure = (mr * l.p - ml * r.p + mr * ml * jump) * difference;
  return s;
}

/// HLLC (Toro, Spruce & Speares 1994; Toro, Riemann Solvers, section 10.4) as the flux of the upwind side
/// plus its wave: F_K + q (S* - u_K) (...), q = s/(S_K - S*), s = S_K where that wave runs into the face,
/// else 0.
EJECTA_KERNEL Flux flux_hllc(const GasConstants& gas, const Primitive& l, const Primitive& r,
                             const WaveSpeeds& s) {
  const bool left = s.contact >= 0;
  const Real rho = left ? l.rho : r.rho, un = left ? l.un : r.un, p = left ? l.p : r.p;
  const Real ut = left ? l.ut : r.ut, us = left ? l.us : r.us;
  const Real outer = left ? s.left : s.right;
  const Real entering = left ? (outer < 0 ? outer : Real(0)) : (outer > 0 ? outer : Real(0));
  const Real q = entering / (outer - s.contact), d = s.contact - un;
  const Real e = p * gas.inv_gamma_minus_1 + Real(0.5) * rho * (un * un + ut * ut + us * us);
  Flux f;
  f.mass = rho * (un + q * d);
  f.un = rho * un * un + p + q * rho * outer * d;
  f.ut = f.mass * ut;
  f.us = f.mass * us;
  f.energy = un * (e + p + gas.reference_enthalpy) +
             q * (d * (e + gas.reference_enthalpy) + s.pressure * s.contact - p * un);
  return f;
}

/// HLL (Harten, Lax & van Leer 1983): no contact, hence no carbuncle, but smeared shear.
EJECTA_KERNEL Flux flux_hll(const GasConstants& gas, const Primitive& l, const Primitive& r,
                            const WaveSpeeds& s) {
  const Real a = s.left < 0 ? s.left : Real(0), b = s.right > 0 ? s.right : Real(0);
  const Real inv = 1 / (b - a), wl = b * inv, wr = -a * inv, w = a * b * inv;
  const Real ml = l.rho * l.un, mr = r.rho * r.un;
  const Real el = energy(gas, l), er = energy(gas, r);
  Flux f;
  f.mass = wl * ml + wr * mr + w * (r.rho - l.rho);
  f.un = wl * (ml * l.un + l.p) + wr * (mr * r.un + r.p) + w * (mr - ml);
  f.ut = wl * ml * l.ut + wr * mr * r.ut + w * (r.rho * r.ut - l.rho * l.ut);
  f.us = wl * ml * l.us + wr * mr * r.us + w * (r.rho * r.us - l.rho * l.us);
  f.energy = wl * l.un * (el + l.p + gas.reference_enthalpy) +
             wr * r.un * (er + r.p + gas.reference_enthalpy) + w * (er - el);
  return f;
}

/// Share of HLLC against a carbuncle: 1 where the pressure is even *across* the sweep, towards 0 beside a
/// strong shock that runs along it: evenness^3 with evenness = p_min/p_max of the cells beside the face (Kim,
/// Kim, Rho & Hong 2003, J. Comput. Phys. 185:342, function f).
EJECTA_KERNEL Real hllc_share(Real evenness) { return evenness * evenness * evenness; }

EJECTA_KERNEL Flux blend(const Flux& a, const Flux& b, Real share) {
  const Real rest = 1 - share;
  return {share * a.mass + rest * b.mass, share * a.un + rest * b.un, share * a.ut + rest * b.ut,
          share * a.us + rest * b.us, share * a.energy + rest * b.energy};
}

/// HLLC blended with HLL beside strong shocks, as a convection of FluxKernel.
struct HllcConvection {
  /// Smallest over largest pressure of a cell and its neighbours across the sweep.
  template <class P, class Kernel>
  EJECTA_KERNEL static Real evenness(const Kernel& at, std::ptrdiff_t o, const FaceSite& site) {
    const Real* p = at.w.origin[kP] + o;
    Real low = p[0], high = p[0];
    const auto take = [&](Real q) __attribute__((always_inline)) {
      low = q < low ? q : low;
      high = q > high ? q : high;
    };
    take(p[site.st]);
    take(p[-site.st]);
    if constexpr (P::across) {
      take(p[site.ss]);
      take(p[-site.ss]);
    }
    return (low + at.gas.reference_pressure) / (high + at.gas.reference_pressure);
  }

  template <int D, class P, class Kernel>
  EJECTA_KERNEL Flux flux(const Kernel& at, const Primitive& l, const Primitive& r,
                          const FaceSite& site) const {
    const WaveSpeeds speeds = wave_speeds_einfeldt(at.gas, l, r);
    const Real e1 = evenness<P>(at, site.o, site), e2 = evenness<P>(at, site.o - site.s, site);
    return blend(flux_hllc(at.gas, l, r, speeds), flux_hll(at.gas, l, r, speeds),
                 hllc_share(e1 < e2 ? e1 : e2));
  }
};

}  // namespace ejecta::gas
