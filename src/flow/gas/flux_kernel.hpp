#pragma once
#include "flow/gas/flux_viscous.hpp"
#include "flow/gas/geometry.hpp"
#include "flow/gas/limiter.hpp"
#include "flow/gas/state.hpp"

namespace ejecta::gas {

/// What a sweep carries: known when it is compiled, so that a laminar plane flow pays for nothing else.
template <bool Viscous, bool Turbulent, bool Across>
struct Physics {
  static constexpr bool viscous = Viscous;
  static constexpr bool turbulent = Turbulent;  ///< two transported quantities; implies viscous
  static constexpr bool across = Across;        ///< velocity and neighbours along y
};

/// Constants of diffusion. Diffusivity of a turbulent quantity: mu + sigma mu_t, sigma = outer + F1 (inner -
/// outer) with the blending function of k-omega SST; for k-epsilon both are equal.
struct Diffusion {
  Real viscosity = 0;                         ///< Pa s
  Real conductivity = 0;                      ///< cp/Pr, times mu: W/m/K
  Real fastest = 0, fastest_t = 0;            ///< of the stable step: 2 gamma/Pr, 2 gamma/Pr_t
  Real conductivity_t = 0;                    ///< cp/Pr_t, times mu_t
  Real sigma_k = 1, sigma_e = 1;              ///< outer
  Real inner_sigma_k = 0, inner_sigma_e = 0;  ///< inner - outer
};

/// Where a sweep stands: a face and its neighbourhood.
struct FaceSite {
  std::ptrdiff_t o;          ///< offset of the cell above the face
  std::ptrdiff_t s, st, ss;  ///< strides along the sweep and across it (t in the x-z plane, s the other)
  int m;                     ///< index along the sweep
};

/// Flux through the lower face along axis D of cell (i, j, k): MUSCL on the primitive variables, what
/// `convection` makes of the two sides, central viscous fluxes. Written per area into `flux`.
///
///   convection.flux<D, P>(kernel, left, right, site) -> Flux
template <int D, class P, class Convection>
struct FluxKernel {
  BlockView<const Real> w;
  BlockView<Real> flux;
  const Real* eddy_viscosity;  ///< same strides as w
  const Real* f1;
  GasConstants gas;
  Diffusion diffusion;
  std::array<AxisLengths, 3> axis;
  Convection convection;

  // The sweep's own names: n along it, t across it in the x-z plane, s the remaining direction.
  static constexpr int n_axis = D, t_axis = D == 0 ? 2 : 0, s_axis = D == 1 ? 2 : 1;
  static constexpr int cn = kU + n_axis, ct = kU + t_axis, cs = kU + s_axis;

  struct Sides {
    Real left, right;
  };

  EJECTA_KERNEL static constexpr std::ptrdiff_t pick(int d, std::ptrdiff_t sy, std::ptrdiff_t sz) {
    return d == 0 ? 1 : d == 1 ? sy : sz;
  }

  EJECTA_KERNEL Sides reconstruct(int c, std::ptrdiff_t o, std::ptrdiff_t s, int m) const {
    const Metrics& g = axis[n_axis].metrics;
    const Real* v = w.origin[static_cast<std::size_t>(c)] + o;
    const Real a = v[-2 * s], b = v[-s], d = v[0], e = v[s];
    const Real below = (b - a) * g.inv_distance[m - 1], here = (d - b) * g.inv_distance[m],
               above = (e - d) * g.inv_distance[m + 1];
    return {b + Real(0.5) * g.width[m - 1] * limiter_van_leer(below, here),
            d - Real(0.5) * g.width[m] * limiter_van_leer(here, above)};
  }

  /// d(component c)/d(axis a) on the face: mean of the central differences in the two cells beside it.
  EJECTA_KERNEL Real across_face(int c, int a, std::ptrdiff_t o, std::ptrdiff_t s, std::ptrdiff_t st,
                                 int index) const {
    const Real* v = w.origin[static_cast<std::size_t>(c)] + o;
    return Real(0.5) * axis[static_cast<std::size_t>(a)].inv_span[index] *
           ((v[st] - v[-st]) + (v[st - s] - v[-st - s]));
  }

  EJECTA_KERNEL void operator()(int i, int j, int k) const {
    const std::ptrdiff_t o = w.offset(i, j, k);
    const std::ptrdiff_t s = pick(n_axis, w.sy, w.sz), st = pick(t_axis, w.sy, w.sz),
                         ss = pick(s_axis, w.sy, w.sz);
    const int m = D == 0 ? i : D == 1 ? j : k;
    const int mt = t_axis == 0 ? i : k, ms = s_axis == 1 ? j : k;

    const Sides rho = reconstruct(kRho, o, s, m), un = reconstruct(cn, o, s, m),
                ut = reconstruct(ct, o, s, m), p = reconstruct(kP, o, s, m);
    Sides us{0, 0};
    if constexpr (P::across) us = reconstruct(cs, o, s, m);
    const Primitive l{rho.left, un.left, ut.left, us.left, p.left};
    const Primitive r{rho.right, un.right, ut.right, us.right, p.right};
    Flux f = convection.template flux<D, P>(*this, l, r, FaceSite{o, s, st, ss, m});

    if constexpr (P::viscous) add_diffusion(f, i, o, s, st, ss, m, mt, ms);
    flux.at(kRho, o) = f.mass;
    flux.at(cn, o) = f.un;
    flux.at(ct, o) = f.ut;
    if constexpr (P::across) flux.at(cs, o) = f.us;
    flux.at(kP, o) = f.energy;
    if constexpr (P::turbulent) {
      const Sides tk = reconstruct(kK, o, s, m), te = reconstruct(kE, o, s, m);
      const bool left = f.mass >= 0;
      const Real mut = Real(0.5) * (eddy_viscosity[o] + eddy_viscosity[o - s]);
      const Real blending = Real(0.5) * (f1[o] + f1[o - s]);
      const Real inv = axis[n_axis].metrics.inv_distance[m];
      const Real* vk = w.origin[kK] + o;
      const Real* ve = w.origin[kE] + o;
      flux.at(kK, o) =
          f.mass * (left ? tk.left : tk.right) -
          (diffusion.viscosity + mut * (diffusion.sigma_k + blending * diffusion.inner_sigma_k)) * inv *
              (vk[0] - vk[-s]);
      flux.at(kE, o) =
          f.mass * (left ? te.left : te.right) -
          (diffusion.viscosity + mut * (diffusion.sigma_e + blending * diffusion.inner_sigma_e)) * inv *
              (ve[0] - ve[-s]);
    }
  }

  EJECTA_KERNEL void add_diffusion(Flux& f, int i, std::ptrdiff_t o, std::ptrdiff_t s, std::ptrdiff_t st,
                                   std::ptrdiff_t ss, int m, int mt, int ms) const {
    const Metrics& g = axis[n_axis].metrics;
    const auto value = [&](int c, std::ptrdiff_t at) __attribute__((always_inline)) {
      return w.origin[static_cast<std::size_t>(c)][at];
    };
    const auto mean = [&](int c) __attribute__((always_inline)) {
      return g.weight[m] * value(c, o - s) + (1 - g.weight[m]) * value(c, o);
    };
    const auto normal = [&](int c) __attribute__((always_inline)) {
      return g.inv_distance[m] * (value(c, o) - value(c, o - s));
    };
    Real mut = 0;
    if constexpr (P::turbulent) mut = Real(0.5) * (eddy_viscosity[o] + eddy_viscosity[o - s]);
    const Real un = mean(cn), ut = mean(ct);
    FaceGradients d{};
    d.nn = normal(cn);
    d.nt = normal(ct);
    d.tn = across_face(cn, t_axis, o, s, st, mt);
    d.tt = across_face(ct, t_axis, o, s, st, mt);
    if constexpr (P::across) {
      d.ns = normal(cs);
      d.sn = across_face(cn, s_axis, o, s, ss, ms);
      d.ss = across_face(cs, s_axis, o, s, ss, ms);
    }
    d.hoop = D == 0 ? un * axis[0].inv_radius_face[i] : D == 2 ? ut * axis[0].inv_radius_centre[i] : Real(0);
    const FaceStress tau = stress_newtonian(diffusion.viscosity + mut, d);
    const auto temperature = [&](std::ptrdiff_t at) __attribute__((always_inline)) {
      return (value(kP, at) + gas.reference_pressure) / (value(kRho, at) * gas.gas_constant);
    };
    const Real heat = (diffusion.conductivity + mut * diffusion.conductivity_t) * g.inv_distance[m] *
                      (temperature(o) - temperature(o - s));
    f.un -= tau.nn;
    f.ut -= tau.nt;
    f.energy -= un * tau.nn + ut * tau.nt + heat;
    if constexpr (P::across) {
      f.us -= tau.ns;
      f.energy -= mean(cs) * tau.ns;
    }
  }
};

}  // namespace ejecta::gas
