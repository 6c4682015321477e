#include "flow/godunov/solver.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <span>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "flow/godunov/update_kernel.hpp"

namespace ejecta::godunov {
namespace {

/// A stage of Runge-Kutta: weight of the step's start in it, and of its fluxes in the whole step.
struct Stage {
  double keep, share;
};
constexpr std::array<Stage, 2> kHeun{{{0.0, 0.5}, {0.5, 0.5}}};
constexpr std::array<Stage, 3> kThirdOrder{{{0.0, 1.0 / 6.0}, {0.75, 1.0 / 6.0}, {1.0 / 3.0, 2.0 / 3.0}}};

Block make_block(const Grid& grid) {
  Block b;
  for (Field& f : b) f = grid.make_field();
  return b;
}

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

Solver::Solver(const Grid& grid, const Options& options)
    : grid_(grid),
      options_(options),
      gas_(options.gas.gamma, options.gas.gas_constant, options.reference_pressure),
      geometry_(grid),
      boundaries_(grid, gas_),
      u_(make_block(grid)),
      start_(make_block(grid)),
      w_(make_block(grid)),
      next_(make_block(grid)),
      fx_(make_block(grid)),
      fy_(make_block(grid)),
      fz_(make_block(grid)),
      eddy_viscosity_(grid.make_field()),
      f1_(grid.make_field()) {
  const double cp = options.gas.specific_heat_pressure();
  diffusion_.viscosity = Real(options.viscosity);
  diffusion_.conductivity = Real(options.viscosity * cp / options.prandtl);
  diffusion_.conductivity_t = Real(cp / options.prandtl_turbulent);
  // Explicit diffusion is stable for dt <= h^2/(2 nu); heat diffuses fastest, with gamma/Pr of the momentum.
  diffusion_.fastest = Real(2.0 * options.gas.gamma / options.prandtl);
  diffusion_.fastest_t = Real(2.0 * options.gas.gamma / options.prandtl_turbulent);
  set_turbulence_constants();
}

void Solver::set(int i, int j, int k, const GasState& s) {
  const double p = s.pressure - options_.reference_pressure;
  const std::array<double, kComponents> primitive{
      s.density, s.velocity.x(), s.velocity.y(), s.velocity.z(), p, s.k, s.e};
  const double energy = p / (options_.gas.gamma - 1.0) + 0.5 * s.density * s.velocity.squaredNorm();
  for (std::size_t c = 0; c < kComponents; ++c) {
    w_[c](i, j, k) = Real(primitive[c]);
    u_[c](i, j, k) = Real(c == kRho ? s.density : c == kP ? energy : s.density * primitive[c]);
  }
}

GasState Solver::at(int i, int j, int k) const {
  const auto v = [&](int c) { return double(w_[static_cast<std::size_t>(c)](i, j, k)); };
  return {v(kRho), {v(kU), v(kV), v(kW)}, v(kP) + options_.reference_pressure, v(kK), v(kE)};
}

double Solver::stable_dt(double courant) const {
  RateKernel kernel{view_block<const Real>(w_), eddy_viscosity_.view().origin, gas_, diffusion_, {}};
  for (int d = 0; d < 3; ++d) kernel.inv_width[static_cast<std::size_t>(d)] = geometry_.axis(d).inv_width;
  const double rate = double(reduce_max(grid_.range(), kernel));
  if (std::isfinite(rate) && rate > 0.0) return courant / rate;
  for (int k = 0; k < grid_.nz(); ++k)
    for (int j = 0; j < grid_.ny(); ++j)
      for (int i = 0; i < grid_.nx(); ++i) {
        const GasState s = at(i, j, k);
        if (s.density > 0.0 && s.pressure > 0.0 && std::isfinite(s.velocity.sum())) continue;
        const Vec3 x = grid_.centre(i, j, k);
        throw DivergedError(
            fmt::format("the gas at ({:.4g}, {:.4g}, {:.4g}) m has density {:.4g} kg/m3 and pressure {:.4g} "
                        "Pa; try a smaller "
                        "run.courant",
                        x.x(), x.y(), x.z(), s.density, s.pressure));
      }
  throw DivergedError("no stable time step: a velocity or an eddy viscosity is no number");
}

template <class P>
void Solver::fluxes() {
  const std::array<AxisLengths, 3> axis{geometry_.axis(0), geometry_.axis(1), geometry_.axis(2)};
  const auto w = view_block<const Real>(w_);
  const Real *mut = eddy_viscosity_.view().origin, *f1 = f1_.view().origin;
  Range3 r = grid_.range();
  if (grid_.active(0)) {
    const Range3 faces{r.i0, r.i1 + 1, r.j0, r.j1, r.k0, r.k1};
    for_each_cell(faces, FluxKernel<0, P>{w, view_block<Real>(fx_), mut, f1, gas_, diffusion_, axis});
  }
  if constexpr (P::across) {
    const Range3 faces{r.i0, r.i1, r.j0, r.j1 + 1, r.k0, r.k1};
    for_each_cell(faces, FluxKernel<1, P>{w, view_block<Real>(fy_), mut, f1, gas_, diffusion_, axis});
  }
  if (grid_.active(2)) {
    const Range3 faces{r.i0, r.i1, r.j0, r.j1, r.k0, r.k1 + 1};
    for_each_cell(faces, FluxKernel<2, P>{w, view_block<Real>(fz_), mut, f1, gas_, diffusion_, axis});
  }
}

template <class P>
void Solver::run_stages(double dt) {
  std::swap(u_, start_);
  const auto run = [&](const Stage& stage, const Block& previous) {
    boundaries_.fill(w_);
    fluxes<P>();
    if (options_.keep_ledger) add_to_ledger(stage.share * dt);
    for_each_cell(grid_.range(), UpdateKernel<P>{view_block<Real>(u_),
                                                 view_block<Real>(next_),
                                                 view_block<const Real>(w_),
                                                 view_block<const Real>(start_),
                                                 view_block<const Real>(previous),
                                                 view_block<const Real>(fx_),
                                                 view_block<const Real>(fy_),
                                                 view_block<const Real>(fz_),
                                                 eddy_viscosity_.view().origin,
                                                 gas_,
                                                 diffusion_,
                                                 {geometry_.axis(0), geometry_.axis(1), geometry_.axis(2)},
                                                 Real(dt),
                                                 Real(stage.keep)});
    std::swap(w_, next_);
  };
  const std::span<const Stage> stages =
      options_.stages == 2 ? std::span<const Stage>(kHeun) : std::span<const Stage>(kThirdOrder);
  for (const Stage& stage : stages) run(stage, &stage == stages.data() ? start_ : u_);
}

void Solver::advance(double dt) {
  const bool across = grid_.active(1), viscous = options_.viscosity > 0.0;
  const bool turbulent = options_.turbulence != TurbulenceModel::laminar;
  if (turbulent) {
    if (options_.turbulence == TurbulenceModel::k_omega_sst) turbulence<true, false>(dt);
    else options_.round_jet_correction ? turbulence<false, true>(dt) : turbulence<false, false>(dt);
  }
  if (turbulent) {
    across ? run_stages<Physics<true, true, true>>(dt) : run_stages<Physics<true, true, false>>(dt);
  } else if (viscous) {
    across ? run_stages<Physics<true, false, true>>(dt) : run_stages<Physics<true, false, false>>(dt);
  } else {
    across ? run_stages<Physics<false, false, true>>(dt) : run_stages<Physics<false, false, false>>(dt);
  }
}

double Solver::total(Component c) const {
  const Metrics x = grid_.metrics(0), y = grid_.metrics(1), z = grid_.metrics(2);
  const auto u = u_[static_cast<std::size_t>(c)].view();
  const double around = grid_.axisymmetric() ? 2.0 * std::numbers::pi : 1.0;
  return around * reduce_sum(grid_.range(), [=](int i, int j, int k) {
           return double(u(i, j, k)) * double(x.volume[i]) * double(y.volume[j]) * double(z.volume[k]);
         });
}

}  // namespace ejecta::godunov
