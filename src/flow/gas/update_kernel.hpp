#pragma once
#include "flow/gas/flux_kernel.hpp"

namespace ejecta::gas {

/// Density, velocity and pressure of conserved values, into cell `o` of `w`. Momentum across counts where P
/// says so.
template <class P>
EJECTA_KERNEL void store_primitive(const BlockView<Real>& w, std::ptrdiff_t o, const GasConstants& gas,
                                   Real rho, Real mu, Real mv, Real mw, Real energy) {
  const Real inv = 1 / rho;
  w.at(kRho, o) = rho;
  w.at(kU, o) = mu * inv;
  w.at(kW, o) = mw * inv;
  if constexpr (P::across) w.at(kV, o) = mv * inv;
  w.at(kP, o) = (gas.gamma - 1) * (energy - Real(0.5) * inv * (mu * mu + mv * mv + mw * mw));
}

/// One stage of a strong-stability-preserving Runge-Kutta method in the form of Shu & Osher (1988):
/// U <- keep U0 + (1 - keep) (V + dt L), L = -div F + the pressure of the hoop in axisymmetric geometry; and
/// the primitive variables of the result.
template <class P>
struct UpdateKernel {
  BlockView<Real> u, next;  ///< conserved and primitive result; `next` is not `w`: neighbours still read it
  BlockView<const Real> w;
  BlockView<const Real> start, previous;  ///< U0 and V
  BlockView<const Real> fx, fy, fz;
  const Real* eddy_viscosity;
  GasConstants gas;
  Diffusion diffusion;
  std::array<AxisLengths, 3> axis;
  Real dt, keep;

  /// Stress along the hoop, 2 mu (u_r/r - div u / 3)
  EJECTA_KERNEL Real hoop_stress(int i, int k, std::ptrdiff_t o) const {
    const Real* ur = w.origin[kU] + o;
    const Real* uz = w.origin[kW] + o;
    const Real hoop = ur[0] * axis[0].inv_radius_centre[i];
    const Real divergence =
        hoop + axis[0].inv_span[i] * (ur[1] - ur[-1]) + axis[2].inv_span[k] * (uz[w.sz] - uz[-w.sz]);
    Real mu = diffusion.viscosity;
    if constexpr (P::turbulent) mu += eddy_viscosity[o];
    return 2 * mu * (hoop - Real(1.0 / 3.0) * divergence);
  }

  EJECTA_KERNEL Real residual(int c, std::ptrdiff_t o, int i, int j, int k) const {
    const Metrics &x = axis[0].metrics, &z = axis[2].metrics;
    Real r = x.inv_volume[i] * (x.area[i] * fx.at(c, o) - x.area[i + 1] * fx.at(c, o + 1)) +
             z.inv_volume[k] * (fz.at(c, o) - fz.at(c, o + w.sz));
    if constexpr (P::across) r += axis[1].metrics.inv_volume[j] * (fy.at(c, o) - fy.at(c, o + w.sy));
    return r;
  }

  EJECTA_KERNEL Real advance(int c, std::ptrdiff_t o, Real rate) const {
    const Real value = keep * start.at(c, o) + (1 - keep) * (previous.at(c, o) + dt * rate);
    u.at(c, o) = value;
    return value;
  }

  EJECTA_KERNEL void operator()(int i, int j, int k) const {
    const std::ptrdiff_t o = w.offset(i, j, k);
    Real hoop_pressure = w.at(kP, o);
    if constexpr (P::viscous) hoop_pressure -= hoop_stress(i, k, o);
    const Real rho = advance(kRho, o, residual(kRho, o, i, j, k));
    const Real mu = advance(kU, o, residual(kU, o, i, j, k) + axis[0].hoop[i] * hoop_pressure);
    const Real mw = advance(kW, o, residual(kW, o, i, j, k));
    Real mv = 0;
    if constexpr (P::across) mv = advance(kV, o, residual(kV, o, i, j, k));
    const Real energy = advance(kP, o, residual(kP, o, i, j, k));
    store_primitive<P>(next, o, gas, rho, mu, mv, mw, energy);
    if constexpr (P::turbulent) {
      const Real inv = 1 / rho;
      next.at(kK, o) = advance(kK, o, residual(kK, o, i, j, k)) * inv;
      next.at(kE, o) = advance(kE, o, residual(kE, o, i, j, k)) * inv;
    }
  }
};

}  // namespace ejecta::gas
