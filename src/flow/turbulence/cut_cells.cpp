// Turbulence in cells that solids cut: what passes their open faces, and their walls by the law of the wall.
#include <algorithm>
#include <cmath>

#include "flow/cut_ghosts.hpp"
#include "flow/turbulence/two_equation.hpp"
#include "flow/turbulence/wall_cell.hpp"

namespace ejecta {
void TwoEquation::advance_cut_cells(const CutCells& cut, const std::array<ConstFieldView, 3>& u,
                                    const std::array<FieldView, 3>& q, Real dt, bool increments) {
  const bool sst = model_ == TwoEquationModel::k_omega_sst;
  for_each_index(static_cast<int>(cut.cells.size()), [&](int n) {
    const CutCell& c = cut.cells[static_cast<std::size_t>(n)];
    if (c.carrier != n) return;
    const Real k0 = k_(c.i, c.j, c.k), s0 = dissipation_(c.i, c.j, c.k), nut = nut_(c.i, c.j, c.k);
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
                         balance_s += through(dissipation_, s0, sigma_s);
                       });
    const Real by_volume = dt / (c.carried * static_cast<Real>(grid_.volume(c.i, c.j, c.k)));
    SourcePoint p{k0, s0, k0 - by_volume * balance_k, s0 - by_volume * balance_s, 0, 0, nut, 0, 0, 0};
    if (sst) p.f1 = f1_(c.i, c.j, c.k);
    const SourceResult r = sst ? advance_wall_sources<true>(grid_, cut, c, u, p, nu_, dt)
                               : advance_wall_sources<false>(grid_, cut, c, u, p, nu_, dt);
    k_new_(c.i, c.j, c.k) = increments ? r.k - k0 : positive_sum(k0, r.k - k0);
    dissipation_new_(c.i, c.j, c.k) = increments ? r.dissipation - s0 : positive_sum(s0, r.dissipation - s0);
  });
  for_each_index(static_cast<int>(cut.ghosts.size()), [&](int n) {
    const GhostCell& g = cut.ghosts[static_cast<std::size_t>(n)];
    k_new_(g.i, g.j, g.k) = increments ? Real(0) : k_(g.i, g.j, g.k);
    dissipation_new_(g.i, g.j, g.k) = increments ? Real(0) : dissipation_(g.i, g.j, g.k);
  });
}

void TwoEquation::finish_cut_cells(const CutCells& cut) {
  const bool sst = model_ == TwoEquationModel::k_omega_sst;
  for_each_index(static_cast<int>(cut.cells.size()), [&](int n) {
    const CutCell& c = cut.cells[static_cast<std::size_t>(n)];
    if (c.carrier != n) return;
    const Real k = k_(c.i, c.j, c.k), dissipation = dissipation_(c.i, c.j, c.k);
    nut_(c.i, c.j, c.k) = sst ? wall_eddy_viscosity<true>(k, dissipation, nu_)
                              : wall_eddy_viscosity<false>(k, dissipation, nu_);
    if (sst) f1_(c.i, c.j, c.k) = Real(1);
  });
  for (Field* f : {&k_, &dissipation_, &nut_, &f1_}) extend_to_ghosts(cut, f->view(), ghost_values_);
  for_each_index(static_cast<int>(cut.ghosts.size()), [&](int n) {
    const GhostCell& g = cut.ghosts[static_cast<std::size_t>(n)];
    if (g.donors == 0) nut_(g.i, g.j, g.k) = 0;  // deep inside
  });
}

}  // namespace ejecta
