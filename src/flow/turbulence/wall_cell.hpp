#pragma once
#include <algorithm>
#include <cmath>

#include "flow/cut_geometry.hpp"
#include "flow/stencil.hpp"
#include "flow/turbulence/gradient.hpp"
#include "flow/turbulence/sources.hpp"
#include "flow/turbulence/wall_law.hpp"

/// Turbulence in a cell that solids cut, by the law of the wall: what liquid and gas share.
namespace ejecta {

/// Part of a carrier that its walls rule: all of it where a wall runs across the whole cell, little where one
/// ends.
inline Real wall_share(const Grid& grid, const CutCells& cut, const CutCell& c) {
  Real area = 0;
  for_each_wall(cut, c, [&](const CutWall& w, int) { area += norm(w.area); });
  return std::min(area * width_along_normal(grid, c) / static_cast<Real>(grid.volume(c.i, c.j, c.k)),
                  Real(1));
}

/// k and epsilon (omega) of a carrier after the sources of a step dt. `p` holds what is there before; strain
/// and production are filled in here, near walls by their shear. u: velocity of cells, m/s; nu: m2/s.
template <bool kSst>
SourceResult advance_wall_sources(const Grid& grid, const CutCells& cut, const CutCell& c,
                                  const std::array<ConstFieldView, 3>& u, SourcePoint p, Real nu, Real dt) {
  const Real y = wall_distance(grid, c), share = wall_share(grid, cut, c);
  const std::array<Real, 3> v{u[0](c.i, c.j, c.k), u[1](c.i, c.j, c.k), u[2](c.i, c.j, c.k)};
  Real area = 0, at_wall = 0;  // of the walls, and what their shear produces times that
  for_each_wall(cut, c, [&](const CutWall& w, int) {
    const std::array<Real, 3> solid = carried_on(w, y);
    const Real a = norm(w.area),
               speed = norm(along_wall({v[0] - solid[0], v[1] - solid[1], v[2] - solid[2]}, w.area));
    const Real stress = speed * wall_law::conductance(speed, y, nu, p.k, w.roughness);
    area += a;
    const Real star = wall_law::kQuarterCmu * std::sqrt(p.k);
    if (wall_law::beyond_viscous_layer(y, nu, p.k, w.roughness))
      at_wall += a * stress * star / (wall_law::kKappa * y);
  });
  p.strain2 = strain_squared(gradient_row(grid, u, c.j, c.k)(c.i));
  p.produced =
      (Real(1) - share) * p.eddy_viscosity * p.strain2 + (area > Real(0) ? share * at_wall / area : Real(0));
  p.k_carried = positive_sum(p.k, p.k_carried - p.k);
  p.dissipation_carried = positive_sum(p.dissipation, p.dissipation_carried - p.dissipation);
  SourceResult r = advance_sources<kSst, false>(p, dt);
  // Its wall rules the dissipation of a cell at the rate of its turbulence, at once where it runs all across.
  const Real at_wall_dissipation =
      kSst ? wall_law::specific_dissipation(r.k, y, nu) : wall_law::dissipation(r.k, y, nu);
  const Real turnover = kSst ? k_omega_sst::kBetaStar * at_wall_dissipation : at_wall_dissipation / r.k;
  const Real pull = dt * turnover * share / std::max(Real(1) - share, Real(1e-6));
  r.dissipation =
      std::max((r.dissipation + pull * at_wall_dissipation) / (Real(1) + pull), kMinimalDissipation);
  return r;
}

/// nu_t of a carrier, m2/s: that of the law of the wall where k and its dissipation are in equilibrium.
template <bool kSst>
Real wall_eddy_viscosity(Real k, Real dissipation, Real nu) {
  const Real nut = kSst ? k / dissipation : k_epsilon::kCmu * k * k / dissipation;
  return std::min(nut, kLargestViscosityRatio * nu);
}

}  // namespace ejecta
