#pragma once
#include "base/parallel.hpp"

namespace ejecta::gas {

/// Velocity gradients on a face; n along the sweep, t and s across it. `hoop` is u_r/r in axisymmetric
/// geometry.
struct FaceGradients {
  Real nn, nt, ns;  ///< d(un, ut, us)/dn, 1/s
  Real tn, tt;      ///< d(un, ut)/dt
  Real sn, ss;      ///< d(un, us)/ds
  Real hoop;
};

/// Viscous stress on a face of normal n, Pa.
struct FaceStress {
  Real nn, nt, ns;
};

/// Newtonian fluid without bulk viscosity: tau = mu (grad u + grad u^T - 2/3 div u)
EJECTA_KERNEL FaceStress stress_newtonian(Real viscosity, const FaceGradients& g) {
  const Real divergence = g.nn + g.tt + g.ss + g.hoop;
  return {viscosity * (2 * g.nn - Real(2.0 / 3.0) * divergence), viscosity * (g.nt + g.tn),
          viscosity * (g.ns + g.sn)};
}

}  // namespace ejecta::gas
