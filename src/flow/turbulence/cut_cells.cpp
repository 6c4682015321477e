// Turbulence in cells that solids cut: what passes their open faces, and their walls by the law of the wall.
#include <algorithm>
#include <cmath>

#include "flow/cut_geometry.hpp"
#include "flow/cut_ghosts.hpp"
#include "flow/turbulence/gradient.hpp"
#include "flow/turbulence/sources.hpp"
#include "flow/turbulence/two_equation.hpp"
#include "flow/turbulence/wall_law.hpp"

namespace ejecta {
namespace {

/// Part of a carrier that its walls rule: all of it where a wall runs across the whole cell, little where one
/// ends.
Real wall_share(const Grid& grid, const CutCells& cut, const CutCell& c) {
  Real area = 0;
  for_each_wall(cut, c, [&](const CutWall& w, int) { area += norm(w.area); });
  return std::min(area * width_along_normal(grid, c) / static_cast<Real>(grid.volume(c.i, c.j, c.k)),
                  Real(1));
}

}  // namespace

void TwoEquation::advance_cut_cells(const CutCells& cut, const std::array<ConstFieldView, 3>& u,
                                    const std::array<FieldView, 3>& q, Real dt, bool increments) {
  const bool sst = model_ == TwoEquationModel::k_omega_sst;
  for_each_index(static_cast<int>(cut.cells.size()), [&](int n) {
    const CutCell& c = cut.cells[static_cast<std::size_t>(n)];
    if (c.carrier != n) return;
    const Real k0 = k_(c.i, c.j, c.k), s0 = second_(c.i, c.j, c.k), nut = nut_(c.i, c.j, c.k);
    Real balance_k = 0, balance_s = 0;
    for_each_open_face(grid_, cut, c,
                       [&](const CutCell&, int d, const std::array<int, 3>& face, const std::array<int, 3>&,
                           Real sign, Real open, Real area) {
                         const std::size_t s = static_cast<std::size_t>(d);
                         FaceMetrics f = face_metrics(grid_.metrics(d), face[s]);
                         const Real v = q[s](face[0], face[1], face[2]),
                                    travelled = Real(0.5) * std::abs(v) * dt;
                         f.half_low = std::max(f.half_low - travelled, Real(0));
                         f.half_high = std::max(f.half_high - travelled, Real(0));
                         const std::ptrdiff_t step = stride(ConstFieldView(nut_.view()), d);
                         const auto mean = [&](const Field& field) {
                           const Real* p = &field(face[0], face[1], face[2]);
                           return f.weight * p[-step] + (Real(1) - f.weight) * p[0];
                         };
                         const Real eddy = mean(nut_), blend = sst ? mean(f1_) : Real(0);
                         using namespace k_omega_sst;
                         const Real sigma_k = sst ? k_omega_sst::blend(blend, kSigmaK1, kSigmaK2)
                                                  : Real(1) / k_epsilon::kSigmaK;
                         const Real sigma_s = sst ? k_omega_sst::blend(blend, kSigmaW1, kSigmaW2)
                                                  : Real(1) / k_epsilon::kSigmaEpsilon;
                         const auto through = [&](const Field& field, Real here, Real sigma) {
                           const Real* p = &field(face[0], face[1], face[2]);
                           return sign * open * area *
                                  (v * (upwind_value(v, p[-2 * step], p[-step], p[0], p[step], f) - here) -
                                   (nu_ + sigma * eddy) * (p[0] - p[-step]) * f.inv_here);
                         };
                         balance_k += through(k_, k0, sigma_k);
                         balance_s += through(second_, s0, sigma_s);
                       });
    const Real by_volume = dt / (c.carried * static_cast<Real>(grid_.volume(c.i, c.j, c.k)));
    const Real y = wall_distance(grid_, c), share = wall_share(grid_, cut, c);
    const std::array<Real, 3> v{u[0](c.i, c.j, c.k), u[1](c.i, c.j, c.k), u[2](c.i, c.j, c.k)};
    Real area = 0, at_wall = 0;  // of the walls, and what their shear produces times that
    for_each_wall(cut, c, [&](const CutWall& w, int) {
      const Real a = norm(w.area), speed = norm(velocity_along(w, v));
      const Real stress = speed * wall_law::conductance(speed, y, nu_, k0, w.roughness);
      area += a;
      if (wall_law::kQuarterCmu * std::sqrt(k0) * y > wall_law::kLaminar * nu_)
        at_wall += a * stress * wall_law::kQuarterCmu * std::sqrt(k0) / (wall_law::kKappa * y);
    });
    const VelocityGradient gradient = gradient_row(grid_, u, c.j, c.k)(c.i);
    const Real strain2 = strain_squared(gradient);
    SourcePoint p{k0, s0, k0 - by_volume * balance_k, s0 - by_volume * balance_s, strain2, 0, nut, 0, 0, 0};
    p.produced = (Real(1) - share) * nut * strain2 + (area > Real(0) ? share * at_wall / area : Real(0));
    p.k_carried = std::max(p.k_carried, kMinimalK);
    p.second_carried = std::max(p.second_carried, kMinimalSecond);
    SourceResult r;
    if (sst) {
      p.f1 = f1_(c.i, c.j, c.k);
      r = advance_sources<true, false>(p, dt);
    } else {
      r = advance_sources<false, false>(p, dt);
    }
    // Its wall rules the dissipation of a cell at the rate of its turbulence, at once where it runs all
    // across.
    const Real at_wall_s =
        sst ? wall_law::specific_dissipation(r.k, y, nu_) : wall_law::dissipation(r.k, y, nu_);
    const Real turnover = sst ? k_omega_sst::kBetaStar * at_wall_s : at_wall_s / r.k;
    const Real pull = dt * turnover * share / std::max(Real(1) - share, Real(1e-6));
    r.second = std::max((r.second + pull * at_wall_s) / (Real(1) + pull), kMinimalSecond);
    k_new_(c.i, c.j, c.k) = increments ? r.k - k0 : r.k;
    second_new_(c.i, c.j, c.k) = increments ? r.second - s0 : r.second;
  });
  for_each_index(static_cast<int>(cut.ghosts.size()), [&](int n) {
    const GhostCell& g = cut.ghosts[static_cast<std::size_t>(n)];
    k_new_(g.i, g.j, g.k) = increments ? Real(0) : k_(g.i, g.j, g.k);
    second_new_(g.i, g.j, g.k) = increments ? Real(0) : second_(g.i, g.j, g.k);
  });
}

void TwoEquation::finish_cut_cells(const CutCells& cut) {
  const bool sst = model_ == TwoEquationModel::k_omega_sst;
  for_each_index(static_cast<int>(cut.cells.size()), [&](int n) {
    const CutCell& c = cut.cells[static_cast<std::size_t>(n)];
    if (c.carrier != n) return;
    const Real k = k_(c.i, c.j, c.k), second = second_(c.i, c.j, c.k);
    nut_(c.i, c.j, c.k) =
        std::min(sst ? k / second : k_epsilon::kCmu * k * k / second, kLargestViscosityRatio * nu_);
    if (sst) f1_(c.i, c.j, c.k) = Real(1);
  });
  for (Field* f : {&k_, &second_, &nut_, &f1_}) extend_to_ghosts(cut, f->view(), ghost_values_);
  for_each_index(static_cast<int>(cut.ghosts.size()), [&](int n) {
    const GhostCell& g = cut.ghosts[static_cast<std::size_t>(n)];
    if (g.donors == 0) nut_(g.i, g.j, g.k) = 0;  // deep inside
  });
}

}  // namespace ejecta
