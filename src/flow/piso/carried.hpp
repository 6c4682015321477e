#pragma once
#include "flow/gas/flux_kernel.hpp"

/// Kernels of the compressible PISO besides those it shares with Godunov's method.
namespace ejecta::gas {

/// What the velocities of the faces carry and the pressure does, as a convection of FluxKernel: q times the
/// upwind side, the mean pressure as a force, (p + H_ref) q as its power.
struct CarriedConvection {
  std::array<const Real*, 3> velocity;  ///< q along each axis on lower faces, strides of the kernel's w, m/s

  template <int D, class P, class Kernel>
  EJECTA_KERNEL Flux flux(const Kernel& at, const Primitive& l, const Primitive& r,
                          const FaceSite& site) const {
    const Real q = velocity[D][site.o];
    const bool left = q >= 0;
    const Real rho = left ? l.rho : r.rho, un = left ? l.un : r.un, p = left ? l.p : r.p;
    const Real ut = left ? l.ut : r.ut, us = left ? l.us : r.us;
    const Real* pressure = at.w.origin[kP] + site.o;
    const Real below = pressure[-site.s];
    const Real force = below + (1 - at.axis[D].metrics.weight[site.m]) * (pressure[0] - below);
    const Real e = p * at.gas.inv_gamma_minus_1 + Real(0.5) * rho * (un * un + ut * ut + us * us);
    Flux f;
    f.mass = q * rho;
    f.un = f.mass * un + force;
    f.ut = f.mass * ut;
    f.us = f.mass * us;
    f.energy = q * (e + force + at.gas.reference_enthalpy);
    return f;
  }
};

/// The primitive variables half a step on as far as flow and friction change them: w + dt/2 (-u grad w + V),
/// with limited slopes (Hancock's predictor; van Leer 1984) and V the diffusion along the axes. The sum is
/// divided by 1
/// + dt D, D the diagonal of the diffusion, so that it stays bounded beyond the explicit limit of diffusion
/// and vanishes with the sum where the flow is steady.
template <class P>
struct PredictorKernel {
  BlockView<const Real> w;
  BlockView<Real> middle;
  const Real* eddy_viscosity;
  const Real* f1;
  Diffusion diffusion;
  std::array<AxisLengths, 3> axis;
  Real dt;

  /// Along one axis: stride, index, velocity, and the viscosities on the two faces times area over volume.
  struct Along {
    const Metrics* metrics;
    std::ptrdiff_t s;
    int at;
    Real u, low, high;
    EJECTA_KERNEL Real below(const Real* v) const { return (v[0] - v[-s]) * metrics->inv_distance[at]; }
    EJECTA_KERNEL Real above(const Real* v) const { return (v[s] - v[0]) * metrics->inv_distance[at + 1]; }
    EJECTA_KERNEL Real carried(const Real* v) const { return u * limiter_van_leer(below(v), above(v)); }
    EJECTA_KERNEL Real diffused(const Real* v) const { return high * above(v) - low * below(v); }
    EJECTA_KERNEL Real diagonal() const {
      return high * metrics->inv_distance[at + 1] + low * metrics->inv_distance[at];
    }
  };

  EJECTA_KERNEL Along along(int d, std::ptrdiff_t o, std::ptrdiff_t s, int at) const {
    const Metrics& m = axis[static_cast<std::size_t>(d)].metrics;
    Along a{&m, s, at, w.at(kU + d, o), 0, 0};
    if constexpr (P::viscous) {
      Real low = diffusion.viscosity, high = low;
      if constexpr (P::turbulent) {
        low += Real(0.5) * (eddy_viscosity[o] + eddy_viscosity[o - s]);
        high += Real(0.5) * (eddy_viscosity[o] + eddy_viscosity[o + s]);
      }
      a.low = low * m.area[at] * m.inv_volume[at];
      a.high = high * m.area[at + 1] * m.inv_volume[at];
    }
    return a;
  }

  EJECTA_KERNEL void operator()(int i, int j, int k) const {
    const std::ptrdiff_t o = w.offset(i, j, k);
    const Along x = along(0, o, 1, i), z = along(2, o, w.sz, k);
    Along y{};
    if constexpr (P::across) y = along(1, o, w.sy, j);
    const auto carried = [&](int c) __attribute__((always_inline)) {
      const Real* v = w.origin[static_cast<std::size_t>(c)] + o;
      Real sum = x.carried(v) + z.carried(v);
      if constexpr (P::across) sum += y.carried(v);
      return sum;
    };
    const Real half = Real(0.5) * dt, inv_rho = 1 / w.at(kRho, o);
    middle.at(kRho, o) = w.at(kRho, o) - half * carried(kRho);
    middle.at(kP, o) = w.at(kP, o) - half * carried(kP);
    // `hoop`: of the radial velocity in axisymmetric geometry, -mu u_r/r^2
    const auto advance = [&](int c, Real share, Real hoop) __attribute__((always_inline)) {
      const Real* v = w.origin[static_cast<std::size_t>(c)] + o;
      if constexpr (P::viscous) {
        Real sum = x.diffused(v) + z.diffused(v) - hoop * v[0], diagonal = x.diagonal() + z.diagonal() + hoop;
        if constexpr (P::across) {
          sum += y.diffused(v);
          diagonal += y.diagonal();
        }
        const Real nu = share * inv_rho;
        middle.at(c, o) = v[0] + half * (nu * sum - carried(c)) / (1 + dt * nu * diagonal);
      } else {
        middle.at(c, o) = v[0] - half * carried(c);
      }
    };
    Real hoop = diffusion.viscosity;
    if constexpr (P::turbulent) hoop += eddy_viscosity[o];
    hoop *= axis[0].inv_radius_centre[i] * axis[0].inv_radius_centre[i];
    advance(kU, 1, hoop);
    advance(kW, 1, 0);
    if constexpr (P::across) advance(kV, 1, 0);
    if constexpr (P::turbulent) {
      advance(kK, diffusion.sigma_k + f1[o] * diffusion.inner_sigma_k, 0);
      advance(kE, diffusion.sigma_e + f1[o] * diffusion.inner_sigma_e, 0);
    }
  }
};

/// What the pressure does to the predicted middle of the step once its change dp is known: u - dt/2 grad(p +
/// dp)/rho, density compressed by half of dp, and the pressure p + dp itself.
template <class P>
struct PressureKernel {
  BlockView<Real> middle;
  Real* pressure;      ///< result: the neighbours still read that of `middle`
  const Real* change;  ///< dp with ghosts
  GasConstants gas;
  std::array<AxisLengths, 3> axis;
  Real dt;

  EJECTA_KERNEL Real gradient(int d, std::ptrdiff_t o, std::ptrdiff_t s, int at) const {
    const AxisLengths& a = axis[static_cast<std::size_t>(d)];
    const Real* p = middle.origin[kP] + o;
    const Real *c = change + o, *weight = a.metrics.weight;
    const Real below = p[-s] + c[-s], here = p[0] + c[0], above = p[s] + c[s];
    const Real low = weight[at] * (below - here), high = (1 - weight[at + 1]) * (above - here);
    return (high - low) * a.inv_width[at];
  }

  EJECTA_KERNEL void operator()(int i, int j, int k) const {
    const std::ptrdiff_t o = middle.offset(i, j, k);
    const Real rho = middle.at(kRho, o), half = Real(0.5) * dt / rho, p = middle.at(kP, o);
    middle.at(kU, o) -= half * gradient(0, o, 1, i);
    middle.at(kW, o) -= half * gradient(2, o, middle.sz, k);
    if constexpr (P::across) middle.at(kV, o) -= half * gradient(1, o, middle.sy, j);
    middle.at(kRho, o) = rho + Real(0.5) * change[o] / gas.sound_speed_squared(rho, p);
    pressure[o] = p + change[o];
  }
};

}  // namespace ejecta::gas
