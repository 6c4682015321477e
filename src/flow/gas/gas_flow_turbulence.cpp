#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "flow/gas/gas_flow.hpp"
#include "flow/turbulence/grid_walls.hpp"
#include "flow/turbulence/sources.hpp"
#include "flow/turbulence/wall_cell.hpp"

namespace ejecta::gas {

void GasFlow::set_turbulence_constants() {
  if (options_.turbulence == TurbulenceModel::k_omega_sst) {
    using namespace k_omega_sst;
    diffusion_.sigma_k = kSigmaK2;
    diffusion_.sigma_e = kSigmaW2;
    diffusion_.inner_sigma_k = kSigmaK1 - kSigmaK2;
    diffusion_.inner_sigma_e = kSigmaW1 - kSigmaW2;
  } else {
    diffusion_.sigma_k = 1 / k_epsilon::kSigmaK;
    diffusion_.sigma_e = 1 / k_epsilon::kSigmaEpsilon;
  }
}

void GasFlow::measure_walls() {
  for (int d = 0; d < 3; ++d) {
    const Axis& axis = grid_.axis(d);
    std::vector<Real>& distance = wall_distance_[static_cast<std::size_t>(d)];
    distance.assign(static_cast<std::size_t>(axis.n + kRealLanes), SolidDistance::kNone);  // whole registers
    for (int side = 0; side < 2; ++side) {
      const int face = 2 * d + side;
      if (!grid_.active(d) || !boundaries_.is_wall(face)) continue;
      has_law_of_wall_[static_cast<std::size_t>(face)] = !boundaries_.has_patches(face);
      const double wall = side ? axis.face.back() : axis.face.front();
      for (std::size_t i = 0; i < axis.centre.size(); ++i)
        distance[i] = std::min(distance[i], Real(std::abs(axis.centre[i] - wall)));
    }
  }
}

template <bool Sst, bool RoundJet>
void GasFlow::run_turbulence(double dt, const Dilatation& dilatation) {
  if (!started_) measure_walls();
  started_ = true;
  boundaries_.fill(w_);
  const auto run = [&](auto across) {
    for_each_cell(grid_.range(),
                  TurbulenceKernel<Sst, RoundJet, across>{
                      view_block<const Real>(w_),
                      view_block<Real>(next_),
                      view_block<Real>(u_),
                      eddy_viscosity_.view().origin,
                      f1_.view().origin,
                      {wall_distance_[0].data(), wall_distance_[1].data(), wall_distance_[2].data()},
                      solid_distance_.view(),
                      gas_,
                      axes(),
                      Real(options_.viscosity),
                      Real(dt),
                      options_.compressibility_correction,
                      dilatation});
  };
  grid_.active(1) ? run(std::true_type{}) : run(std::false_type{});
  for (const int c : {kK, kE}) std::swap(w_[static_cast<std::size_t>(c)], next_[static_cast<std::size_t>(c)]);
  boundaries_.extend(eddy_viscosity_);
  if constexpr (Sst) boundaries_.extend(f1_);
  apply_walls<Sst>(Real(dt));  // next_ holds k and epsilon (omega) of before
}

/// Cells beside walls of the box after the sources: k is produced by the shear of the law of the wall, as
/// differences across a wall are no gradients, its dissipation is in equilibrium.
template <bool Sst>
void GasFlow::apply_walls(Real dt) {
  const GridWalls walls(grid_, has_law_of_wall_, {w_[kU].view(), w_[kV].view(), w_[kW].view()});
  walls.for_each_cell([&](int i, int j, int k) {
    const Real rho = w_[kRho](i, j, k), nu = Real(options_.viscosity) / rho;
    const Real k0 = std::max(next_[kK](i, j, k), kMinimalK),
               e0 = std::max(next_[kE](i, j, k), kMinimalDissipation);
    const WallShear shear = walls.shear(i, j, k, k0, nu);
    const Real nut = wall_eddy_viscosity<Sst>(k0, e0, nu);
    const SourcePoint p{k0, e0, k0, e0, shear.strain2, shear.produced, nut, 0, Real(1), 0};
    const Real kn = advance_sources<Sst, false>(p, dt).k,
               dissipation = walls.dissipation<Sst>(i, j, k, kn, nu);
    set_turbulence(w_, u_, i, j, k, kn, dissipation);
    eddy_viscosity_(i, j, k) = rho * wall_eddy_viscosity<Sst>(kn, dissipation, nu);
    walls.shear_by(eddy_viscosity_.view(), i, j, k, kn, nu, rho);
  });
}

void GasFlow::advance_turbulence(double dt, const Dilatation& dilatation, const CutCells& cut) {
  if (!turbulent()) return;
  if (options_.turbulence == TurbulenceModel::k_omega_sst) {
    solid_distance_.measure(cut);
    run_turbulence<true, false>(dt, dilatation);
  } else if (options_.round_jet_correction) run_turbulence<false, true>(dt, dilatation);
  else run_turbulence<false, false>(dt, dilatation);
}

}  // namespace ejecta::gas
