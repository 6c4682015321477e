#include "flow/godunov/solver.hpp"

#include <cmath>
#include <span>

#include "base/parallel.hpp"
#include "flow/gas/update_kernel.hpp"
#include "flow/godunov/flux_wall.hpp"

namespace ejecta::gas {
namespace {

/// A stage of Runge-Kutta: weight of the step's start in it, and of its fluxes in the whole step.
struct Stage {
  double keep, share;
};
constexpr std::array<Stage, 2> kHeun{{{0.0, 0.5}, {0.5, 0.5}}};
constexpr std::array<Stage, 3> kThirdOrder{{{0.0, 1.0 / 6.0}, {0.75, 1.0 / 6.0}, {1.0 / 3.0, 2.0 / 3.0}}};

/// Inverse of the stable step of one cell.
struct RateKernel {
  BlockView<const Real> w;
  const Real* eddy_viscosity;
  GasConstants gas;
  Diffusion diffusion;
  std::array<const Real*, 3> inv_width;  ///< null where the axis carries no flux
  EJECTA_KERNEL Real operator()(int i, int j, int k) const {
    const std::ptrdiff_t o = w.offset(i, j, k);
    const Real rho = w.at(kRho, o), c = std::sqrt(gas.sound_speed_squared(rho, w.at(kP, o)));
    const Real hx = inv_width[0][i], hy = inv_width[1][j], hz = inv_width[2][k];
    const Real nu = (diffusion.fastest * diffusion.viscosity + diffusion.fastest_t * eddy_viscosity[o]) / rho;
    return (std::abs(w.at(kU, o)) + c) * hx + (std::abs(w.at(kV, o)) + c) * hy +
           (std::abs(w.at(kW, o)) + c) * hz + nu * (hx * hx + hy * hy + hz * hz);
  }
};

}  // namespace

double Solver::stable_dt(double courant) {
  RateKernel kernel{view_block<const Real>(w_), eddy_viscosity_.view().origin, gas_, diffusion_, {}};
  for (int d = 0; d < 3; ++d) kernel.inv_width[static_cast<std::size_t>(d)] = geometry_.axis(d).inv_width;
  const double rate = double(reduce_max(grid_.range(), kernel));
  if (std::isfinite(rate) && rate > 0.0) return courant / rate;
  report_divergence();
}

template <class P>
void Solver::wall_fluxes() {
  for (int face = 0; face < 6; ++face) {
    const int d = face / 2, at = face % 2 ? grid_.n(d) : 0;
    const bool on_axis = grid_.axisymmetric() && face == 0 && grid_.lower().x() == 0.0;  // no area
    if (!grid_.active(d) || on_axis || !boundaries_.holds_gas_back(face)) continue;
    Range3 faces = grid_.range();
    (d == 0 ? faces.i0 : d == 1 ? faces.j0 : faces.k0) = at;
    (d == 0 ? faces.i1 : d == 1 ? faces.j1 : faces.k1) = at + 1;
    if (d == 0) sweep<0, P>(faces, w_, WallConvection{});
    if constexpr (P::across)
      if (d == 1) sweep<1, P>(faces, w_, WallConvection{});
    if (d == 2) sweep<2, P>(faces, w_, WallConvection{});
  }
}

template <class P>
void Solver::run_stages(double dt) {
  std::swap(u_, start_);
  const auto run = [&](const Stage& stage, const Block& previous) {
    boundaries_.fill(w_);
    fluxes<P>(w_, HllcConvection{});
    wall_fluxes<P>();
    if (options_.keep_ledger) add_to_ledger(stage.share * dt, {});
    for_each_cell(grid_.range(),
                  UpdateKernel<P>{view_block<Real>(u_), view_block<Real>(next_), view_block<const Real>(w_),
                                  view_block<const Real>(start_), view_block<const Real>(previous),
                                  view_block<const Real>(flux_[0]), view_block<const Real>(flux_[1]),
                                  view_block<const Real>(flux_[2]), eddy_viscosity_.view().origin, gas_,
                                  diffusion_, axes(), Real(dt), Real(stage.keep)});
    std::swap(w_, next_);
  };
  const std::span<const Stage> stages =
      options_.stages == 2 ? std::span<const Stage>(kHeun) : std::span<const Stage>(kThirdOrder);
  for (const Stage& stage : stages) run(stage, &stage == stages.data() ? start_ : u_);
}

void Solver::advance(double dt, CutCells&) {
  advance_turbulence(dt, {}, {});
  with_physics([&](auto physics) { run_stages<decltype(physics)>(dt); });
}

}  // namespace ejecta::gas
