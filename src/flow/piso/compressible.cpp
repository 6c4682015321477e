#include "flow/piso/compressible.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "flow/godunov/update_kernel.hpp"
#include "flow/piso/carried.hpp"
#include "flow/piso/forcing.hpp"
#include "flow/turbulence/closures.hpp"

namespace ejecta::piso {
namespace {

using namespace godunov;

/// Inverse of the convective step of a cell, of its explicit diffusive step, and its viscosity (m2/s). The
/// speed on an axis is the largest in the cell and its two neighbours. What the pressure adds within the
/// step: dt (r + g dt) = 1 with r = sum |u|/h and g = sum |grad p|/(rho h). Cells inside a solid do not
/// count.
struct RateKernel {
  BlockView<const Real> w;
  const Real *eddy_viscosity, *inside_solid;
  Diffusion diffusion;
  std::array<AxisLengths, 3> axis;
  std::array<bool, 3> active;

  EJECTA_KERNEL void operator()(int i, int j, int k, Real* values) const {
    const std::ptrdiff_t o = w.offset(i, j, k);
    const std::array<std::ptrdiff_t, 3> stride{1, w.sy, w.sz};
    const std::array<int, 3> index{i, j, k};
    const Real inv_rho = 1 / w.at(kRho, o);
    Real r = 0, g = 0, squares = 0;
    for (std::size_t d = 0; d < 3; ++d) {
      if (!active[d]) continue;
      const std::ptrdiff_t s = stride[d];
      const Metrics& m = axis[d].metrics;
      const int at = index[d];
      const Real h = m.inv_width[at];
      const Real *u = w.origin[kU + d] + o, *p = w.origin[kP] + o;
      const Real before = std::abs(u[-s]), here = std::abs(u[0]), after = std::abs(u[s]);
      const Real beside = before > after ? before : after;
      const Real low = std::abs(p[0] - p[-s]) * m.inv_distance[at],
                 high = std::abs(p[s] - p[0]) * m.inv_distance[at + 1];
      r += (here > beside ? here : beside) * h;
      g += (low > high ? low : high) * h;
      squares += h * h;
    }
    const Real nu = diffusion.viscosity * inv_rho, nu_t = eddy_viscosity[o] * inv_rho;
    const Real counts = inside_solid[o] > 0 ? Real(0) : Real(1);
    values[0] = counts * Real(0.5) * (r + std::sqrt(r * r + 4 * g * inv_rho));
    values[1] = counts * (diffusion.fastest * nu + diffusion.fastest_t * nu_t) * squares;
    values[2] = counts * Real(0.5) * (diffusion.fastest * nu + diffusion.fastest_t * nu_t);
  }
};

/// What a step adds to a conserved component. That of the radial momentum is divided by 1 + 2 nu dt/r^2: the
/// stress along the hoop of the cells on the axis is far beyond its explicit limit, and no smoothing along
/// the axes sees it.
struct IncrementKernel {
  ConstFieldView now, before, rho, eddy_viscosity;
  FieldView increment;
  const Real* inv_radius;
  Real hoop;  ///< 2 dt for the radial momentum, else 0, s
  Real viscosity;
  EJECTA_KERNEL void operator()(int i, int j, int k) const {
    const Real nu = (viscosity + eddy_viscosity(i, j, k)) / rho(i, j, k);
    increment(i, j, k) = (now(i, j, k) - before(i, j, k)) / (1 + hoop * nu * inv_radius[i] * inv_radius[i]);
  }
};

/// What a pressure that is only coming up will do is seen in what the last step did: dt (r + g dt) = 1 with
/// the velocity's growth in it. One that made |u| smaller does not count.
struct GrowthKernel {
  BlockView<const Real> w, start;  ///< primitive now, conserved at the beginning of the step
  const Real* inside_solid;
  std::array<const Real*, 3> inv_width;
  std::array<bool, 3> active;
  Real inv_last;  ///< 1/s

  EJECTA_KERNEL Real operator()(int i, int j, int k) const {
    const std::ptrdiff_t o = w.offset(i, j, k);
    const std::array<int, 3> index{i, j, k};
    const Real inv_rho = 1 / start.at(kRho, o);
    Real r = 0, g = 0;
    for (std::size_t d = 0; d < 3; ++d) {
      if (!active[d]) continue;
      const Real h = inv_width[d][index[d]], u = w.origin[kU + d][o];
      const Real change = u - start.origin[kU + d][o] * inv_rho;
      r += std::abs(u) * h;
      g += u * change >= 0 || std::abs(change) > std::abs(u) ? std::abs(change) * h : Real(0);
    }
    return inside_solid[o] > 0 ? Real(0) : Real(0.5) * (r + std::sqrt(r * r + 4 * g * inv_last));
  }
};

template <class P>
struct PrimitiveKernel {
  BlockView<const Real> u;
  BlockView<Real> w;
  GasConstants gas;
  EJECTA_KERNEL void operator()(int i, int j, int k) const {
    const std::ptrdiff_t o = u.offset(i, j, k);
    const Real rho = u.at(kRho, o);
    Real mv = 0;
    if constexpr (P::across) mv = u.at(kV, o);
    store_primitive<P>(w, o, gas, rho, u.at(kU, o), mv, u.at(kW, o), u.at(kP, o));
    if constexpr (P::turbulent) {
      w.at(kK, o) = u.at(kK, o) / rho;
      w.at(kE, o) = u.at(kE, o) / rho;
    }
  }
};

}  // namespace

Compressible::Compressible(const Grid& grid, const Options& options)
    : GasFlow(grid, options),
      acoustic_(grid, gas_),
      smoother_(grid),
      start_(make_block(grid)),
      middle_(make_block(grid)),
      inside_solid_(grid.make_field()) {}

double Compressible::stable_dt(double courant) {
  boundaries_.fill(w_);
  const auto [flow, diffusive, nu] =
      reduce_max<3>(grid_.range(), RateKernel{view_block<const Real>(w_),
                                              eddy_viscosity_.view().origin,
                                              inside_solid_.view().origin,
                                              diffusion_,
                                              axes(),
                                              {grid_.active(0), grid_.active(1), grid_.active(2)}});
  measure_growth();
  const double faster = std::max(double(flow), growth_), both = faster + double(diffusive);
  if (!std::isfinite(double(flow) + both)) report_divergence();
  largest_nu_ = double(nu);
  explicit_dt_ = 1.0 / std::max(double(flow) + double(diffusive), 1e-30);
  return courant / std::max(turbulent() ? faster : both, 1e-30);
}

void Compressible::measure_growth() {
  if (growth_ >= 0.0) return;
  growth_ = double(reduce_max(
      grid_.range(),
      GrowthKernel{view_block<const Real>(w_),
                   view_block<const Real>(start_),
                   inside_solid_.view().origin,
                   {geometry_.axis(0).inv_width, geometry_.axis(1).inv_width, geometry_.axis(2).inv_width},
                   {grid_.active(0), grid_.active(1), grid_.active(2)},
                   Real(1.0 / acoustic_.last_dt())}));
}

std::vector<double*> Compressible::state_numbers() {
  measure_growth();
  return {&acoustic_.last_dt(), &growth_};
}

/// All conserved components by the same operator: were the density left out, the velocity of gas of uneven
/// temperature would be smeared against its mass, and heat would answer the density too late.
template <class P>
void Compressible::smooth_increments(double dt) {
  smoother_.prepare(0.5 * dt * largest_nu_, {}, {});
  Field& increment = next_[kRho];
  for (const int c : {kRho, kU, kV, kW, kP, kK, kE}) {
    if ((c == kV && !P::across) || ((c == kK || c == kE) && !P::turbulent)) continue;
    Field &u = u_[static_cast<std::size_t>(c)], &start = start_[static_cast<std::size_t>(c)];
    for_each_cell(grid_.range(),
                  IncrementKernel{u.view(), start.view(), u_[kRho].view(), eddy_viscosity_.view(),
                                  increment.view(), geometry_.axis(0).inv_radius_centre,
                                  c == kU ? Real(2 * dt) : Real(0), Real(options_.viscosity)});
    IncrementSmoother::Base base{start.view(), Real(1), start.view(), Real(0)};
    if (c == kK || c == kE) base.least = 0;
    smoother_.apply(increment.view(), base);
    std::swap(increment, u);
  }
  for_each_cell(grid_.range(), PrimitiveKernel<P>{view_block<const Real>(u_), view_block<Real>(w_), gas_});
}

/// Inside a solid turbulence only decays, its time scale kept, and there is no eddy viscosity; `next_` holds
/// what was there before the sources. Were epsilon to decay ahead of k, gas that a solid sets free would grow
/// k at the rate of the strain for as long as epsilon needs to come back from nothing.
void Compressible::still_solids(const SolidMask& solids, Real dt) {
  const bool sst = options_.turbulence == TurbulenceModel::k_omega_sst;
  for_each_index(static_cast<int>(solids.cells.size()), [&](int n) {
    const SolidCell& c = solids.cells[static_cast<std::size_t>(n)];
    const Real k = next_[kK](c.i, c.j, c.k), e = next_[kE](c.i, c.j, c.k);
    const Real rate = sst ? k_omega_sst::kBetaStar * e : e / std::max(k, Real(1e-12));
    const auto settle = [&](std::size_t component, Real decayed) {
      Real& value = w_[component](c.i, c.j, c.k);
      value += c.weight * (decayed - value);
      u_[component](c.i, c.j, c.k) = w_[kRho](c.i, c.j, c.k) * value;
    };
    settle(kK, k / (1 + dt * rate));
    settle(kE, sst ? e : e / (1 + dt * rate));
    eddy_viscosity_(c.i, c.j, c.k) *= 1 - c.weight;
  });
}

/// Cells of solids in the middle of the step: their velocity alone.
void Compressible::hold_solids(SolidMask& solids) {
  force_solids(grid_, solids, 0.0, {middle_[kU].view(), middle_[kV].view(), middle_[kW].view()});
}

/// Cells of solids at the end of a step: momentum, kinetic energy and heat.
///
/// Forces changed the velocity of a cell by d from u0, and the energy by their work at the velocity v of the
/// solid, at which its faces move: the heat that was there is E - rho (u0^2/2 + d v), where the conserved
/// values would give E - rho (u0 + d)^2/2. Without this, ghost cells, whose u0 is not v, heat up or freeze.
void Compressible::move_solids(SolidMask& solids, WorkDone work_done) {
  aim_at_solids(solids, {w_[kU].view(), w_[kV].view(), w_[kW].view()});
  for_each_index(static_cast<int>(solids.cells.size()), [&](int n) {
    const SolidCell& c = solids.cells[static_cast<std::size_t>(n)];
    const Real rho = w_[kRho](c.i, c.j, c.k);
    const double volume = grid_.volume(c.i, c.j, c.k);
    Real heat = 0, kinetic = 0;  // J/m3, what they gain
    for (std::size_t d = 0; d < 3; ++d) {
      if (!grid_.active(int(d))) continue;
      Real& velocity = w_[kU + d](c.i, c.j, c.k);
      const Real target = solids.target[static_cast<std::size_t>(n)][d];
      const Real from = work_done == WorkDone::by_solids
                            ? start_[kU + d](c.i, c.j, c.k) / start_[kRho](c.i, c.j, c.k)
                            : target;
      const Real gained = velocity - from, change = c.weight * (target - velocity);
      if (work_done == WorkDone::by_solids) heat += c.weight * rho * gained * (from - c.solid[d]);
      heat += c.weight * rho * Real(0.5) * gained * gained;
      kinetic += rho * change * (velocity + Real(0.5) * change);
      velocity += change;
      u_[kU + d](c.i, c.j, c.k) += rho * change;
      solids.impulse[static_cast<std::size_t>(n)][d] += volume * double(rho * change);
    }
    w_[kP](c.i, c.j, c.k) += (gas_.gamma - 1) * heat;
    u_[kP](c.i, c.j, c.k) += heat + kinetic;
    solids.work[static_cast<std::size_t>(n)] += volume * double(heat + kinetic);
  });
}

template <class P>
void Compressible::step(double dt, SolidMask& solids) {
  for_each_cell(grid_.range(), PredictorKernel<P>{view_block<const Real>(w_), view_block<Real>(middle_),
                                                  eddy_viscosity_.view().origin, f1_.view().origin,
                                                  diffusion_, axes(), Real(dt)});
  hold_solids(solids);
  boundaries_.fill(middle_);
  acoustic_.solve(boundaries_, middle_, dt, solids, inside_solid_);
  for_each_cell(grid_.range(), PressureKernel<P>{view_block<Real>(middle_), next_[kP].view().origin,
                                                 acoustic_.change().view().origin, gas_, axes(), Real(dt)});
  std::swap(middle_[kP], next_[kP]);
  hold_solids(solids);
  boundaries_.fill(middle_);
  acoustic_.let_waves_out(boundaries_, middle_);
  const auto q = [&](int d) { return acoustic_.velocity(d).view().origin; };
  fluxes<P>(middle_, CarriedConvection{{q(0), q(1), q(2)}});
  if (options_.keep_ledger) add_to_ledger(dt);
  std::swap(u_, start_);
  for_each_cell(grid_.range(),
                UpdateKernel<P>{view_block<Real>(u_), view_block<Real>(next_),
                                view_block<const Real>(middle_), view_block<const Real>(start_),
                                view_block<const Real>(start_), view_block<const Real>(flux_[0]),
                                view_block<const Real>(flux_[1]), view_block<const Real>(flux_[2]),
                                eddy_viscosity_.view().origin, gas_, diffusion_, axes(), Real(dt), Real(0)});
  std::swap(w_, next_);
  move_solids(solids, WorkDone::by_solids);
  if (turbulent() && dt > explicit_dt_) {
    smooth_increments<P>(dt);
    move_solids(solids, WorkDone::by_friction);
  }
}

void Compressible::advance(double dt, SolidMask& solids) {
  solids.begin_step();
  if (had_solids_) inside_solid_.fill(0);
  for (const SolidCell& c : solids.cells) inside_solid_(c.i, c.j, c.k) = c.weight;
  had_solids_ = !solids.cells.empty();
  const double last = acoustic_.last_dt();
  advance_turbulence(dt, {acoustic_.change().view().origin, last > 0.0 ? Real(1.0 / last) : Real(0)});
  if (turbulent()) still_solids(solids, Real(dt));
  boundaries_.fill(w_);
  with_physics([&](auto physics) { step<decltype(physics)>(dt, solids); });
  growth_ = -1.0;
  for (std::size_t n = 0; n < solids.cells.size(); ++n) {
    ledger().momentum_of_solids += Vec3(solids.impulse[n][0], solids.impulse[n][1], solids.impulse[n][2]);
    ledger().work_of_solids += solids.work[n];
  }
}

std::vector<Field*> Compressible::state() {
  std::vector<Field*> fields = GasFlow::state();
  fields.push_back(&acoustic_.change());
  fields.push_back(&inside_solid_);
  return fields;
}

}  // namespace ejecta::piso
