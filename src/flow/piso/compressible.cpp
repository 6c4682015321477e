#include "flow/piso/compressible.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "flow/gas/update_kernel.hpp"
#include "flow/grain_exchange.hpp"
#include "flow/piso/carried.hpp"
#include "flow/turbulence/closures.hpp"

namespace ejecta::gas {
namespace {

using namespace gas;

/// Inverse of the convective step of a cell, of its explicit diffusive step, and its viscosity (m2/s). The
/// speed on an axis is the largest in the cell and its two neighbours. What the pressure adds within the
/// step: dt (r + g dt) = 1 with r = sum |u|/h and g = sum |grad p|/(rho h). Cells that keep no gas do not
/// count.
struct RateKernel {
  BlockView<const Real> w;
  const Real *eddy_viscosity, *part;
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
    const Real counts = part[o] > 0 ? Real(1) : Real(0);
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
  const Real* part;
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
    return part[o] > 0 ? Real(0.5) * (r + std::sqrt(r * r + 4 * g * inv_last)) : Real(0);
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
      cut_gas_(grid, gas_, options.viscosity),
      smoother_(grid),
      start_(make_block(grid)),
      middle_(make_block(grid)) {
  part_ = &cut_gas_.carried();
}

double Compressible::stable_dt(double courant) {
  boundaries_.fill(w_);
  const auto [flow, diffusive, nu] =
      reduce_max<3>(grid_.range(), RateKernel{view_block<const Real>(w_),
                                              eddy_viscosity_.view().origin,
                                              part().origin,
                                              diffusion_,
                                              axes(),
                                              {grid_.active(0), grid_.active(1), grid_.active(2)}});
  measure_growth();
  const double faster = std::max(double(flow), growth_), both = faster + double(diffusive);
  if (!std::isfinite(double(flow) + both)) report_divergence();
  largest_nu_ = double(nu);
  explicit_dt_ = 1.0 / std::max(double(flow) + double(diffusive), 1e-30);
  // Smoothing ends at the sides of the box (Incompressible::stable_dt).
  bool continues = false;
  for (int d = 0; d < 3; ++d) continues |= grid_.active(d) && boundaries_.is_periodic(d);
  return courant / std::max(turbulent() && !continues ? faster : both, 1e-30);
}

void Compressible::measure_growth() {
  if (growth_ >= 0.0) return;
  growth_ = double(reduce_max(
      grid_.range(),
      GrowthKernel{view_block<const Real>(w_),
                   view_block<const Real>(start_),
                   part().origin,
                   {geometry_.axis(0).inv_width, geometry_.axis(1).inv_width, geometry_.axis(2).inv_width},
                   {grid_.active(0), grid_.active(1), grid_.active(2)},
                   Real(1.0 / acoustic_.last_dt())}));
}

std::vector<double*> Compressible::state_numbers() {
  measure_growth();
  return {&acoustic_.last_dt(), &growth_, &in_room_};
}

/// All conserved components by the same operator: were the density left out, the velocity of gas of uneven
/// temperature would be smeared against its mass, and heat would answer the density too late.
void Compressible::smooth_increments(double dt, bool across, const CutCells& cut) {
  smoother_.prepare(0.5 * dt * largest_nu_, cut, part());
  Field& increment = next_[kRho];
  for (const int c : {kRho, kU, kV, kW, kP, kK, kE}) {
    if (c == kV && !across) continue;
    Field &u = u_[static_cast<std::size_t>(c)], &start = start_[static_cast<std::size_t>(c)];
    for_each_cell(grid_.range(),
                  IncrementKernel{u.view(), start.view(), u_[kRho].view(), eddy_viscosity_.view(),
                                  increment.view(), geometry_.axis(0).inv_radius_centre,
                                  c == kU ? Real(2 * dt) : Real(0), Real(options_.viscosity)});
    smoother_.apply(increment.view(), {start.view(), Real(1), start.view(), Real(0), c == kK || c == kE});
    std::swap(increment, u);
  }
}

void Compressible::fill_ghosts(Block& w) const {
  boundaries_.fill(w);
  if (takes_room()) grains_->fill_inlets(boundaries_, w);
}

template <class P>
void Compressible::step(double dt, CutCells& cut) {
  for_each_cell(grid_.range(), PredictorKernel<P>{view_block<const Real>(w_), view_block<Real>(middle_),
                                                  eddy_viscosity_.view().origin, f1_.view().origin,
                                                  diffusion_, axes(), Real(dt)});
  cut_gas_.extend(cut, middle_, eddies());
  cut_gas_.extend_pressure(cut, middle_[kP]);
  fill_ghosts(middle_);
  GasGrains* const grains = takes_room() ? &*grains_ : nullptr;
  acoustic_.solve(boundaries_, middle_, dt, cut, grains);
  cut_gas_.keep(cut, middle_);
  for_each_cell(grid_.range(), PressureKernel<P>{view_block<Real>(middle_), next_[kP].view().origin,
                                                 acoustic_.change().view().origin, gas_, axes(), Real(dt)});
  std::swap(middle_[kP], next_[kP]);
  if (grains) grains->drag_middle(middle_);
  if (!cut.empty()) fill_ghosts(middle_);  // of bodies across the faces of the box
  cut_gas_.push(cut, middle_, Real(0.5 * dt));
  cut_gas_.extend(cut, middle_, eddies());
  cut_gas_.extend_pressure(cut, middle_[kP]);
  fill_ghosts(middle_);
  acoustic_.let_waves_out(boundaries_, middle_);
  find_fluxes<P>();
  if (options_.keep_ledger) add_to_ledger(dt, cut);
  std::swap(u_, start_);
  for_each_cell(grid_.range(),
                UpdateKernel<P>{view_block<Real>(u_), view_block<Real>(next_),
                                view_block<const Real>(middle_), view_block<const Real>(start_),
                                view_block<const Real>(start_), view_block<const Real>(flux_[0]),
                                view_block<const Real>(flux_[1]), view_block<const Real>(flux_[2]),
                                eddy_viscosity_.view().origin, gas_, diffusion_, axes(), Real(dt), Real(0)});
  std::swap(w_, next_);
  if (grains) grains->balance(*fraction_, middle_, start_, u_);
  cut_gas_.balance(cut, flux_, start_, middle_, eddies(), u_, w_, Real(dt));
  const bool smoothed = turbulent() && dt > explicit_dt_;
  if (smoothed) smooth_increments(dt, P::across, cut);
  if (grains) grains->settle(*fraction_, u_);
  else if (fraction_) grains_->drag_alone(*fraction_, dt, u_);
  const PrimitiveKernel<P> primitive{view_block<const Real>(u_), view_block<Real>(w_), gas_};
  if (smoothed || fraction_) {
    for_each_cell(grid_.range(), primitive);
  } else {
    for (const CutCell& c : cut.cells) primitive(c.i, c.j, c.k);
    for (const GhostCell& g : cut.ghosts) primitive(g.i, g.j, g.k);
  }
  cut_gas_.settle(cut, eddies(), u_, w_);
}

template <class P>
void Compressible::find_fluxes() {
  const auto all = [&](const auto& q) {
    fluxes<P>(middle_, CarriedConvection{{q(0).view().origin, q(1).view().origin, q(2).view().origin}});
  };
  const auto velocity = [&](int d) -> const Field& { return acoustic_.velocity(d); };
  if (!takes_room()) return all(velocity);
  std::swap(flux_, grains_->surface());
  all([&](int) -> const Field& { return grains_->nothing(); });
  std::swap(flux_, grains_->surface());
  const auto& through = grains_->carry({&velocity(0), &velocity(1), &velocity(2)});
  all([&](int d) -> const Field& { return through[static_cast<std::size_t>(d)]; });
}

void Compressible::advance(double dt, CutCells& cut) {
  const bool solids_are_booked = options_.keep_ledger && (!cut.empty() || had_solids_);
  had_solids_ = !cut.empty();
  const Contents before = solids_are_booked ? contents() : Contents{};
  cut_gas_.begin(cut, u_, w_, dt);
  if (solids_are_booked) ledger().displaced += contents() - before;
  cut_gas_.extend(cut, w_, eddies());
  cut_gas_.extend_pressure(cut, w_[kP]);
  const double last = acoustic_.last_dt();
  advance_turbulence(dt, {acoustic_.change().view().origin, last > 0.0 ? Real(1.0 / last) : Real(0)}, cut);
  if (turbulent())  // next_ holds what was there before the sources
    cut_gas_.advance_turbulence(cut, options_.turbulence == TurbulenceModel::k_omega_sst, next_, w_, u_,
                                eddy_viscosity_, f1_, Real(dt));
  fill_ghosts(w_);
  with_physics([&](auto physics) { step<decltype(physics)>(dt, cut); });
  growth_ = -1.0;
  const CutGas::Given given = cut_gas_.given(cut, start_, dt);
  ledger().momentum_of_solids += given.by_walls.momentum;
  ledger().work_of_solids += given.by_walls.energy;
  ledger().displaced += given.displaced;
}

void Compressible::advance(double dt, CutCells& cut, FluidFraction& f) {
  const bool takes_room = f.acts && cut.empty();
  if (takes_room != (in_room_ > 0.0)) {
    const Contents before = contents();
    in_room_ = takes_room ? 1.0 : 0.0;
    resume();
    if (takes_room)
      for_each_cell(grid_.range(), [part = grains_->part().view(), solids = f.solids_before.view()](
                                       int i, int j, int k) { part(i, j, k) = 1 - solids(i, j, k); });
    if (options_.keep_ledger) ledger().displaced += contents() - before;
  }
  fraction_ = f.acts ? &f : nullptr;
  if (takes_room) grains_->begin(f, boundaries_, dt);
  advance(dt, cut);
  fraction_ = nullptr;
  if (!takes_room) find_results(f);
  if (f.acts && options_.keep_ledger) book_grains(f, dt);
}

/// What grains see of a gas in which they take no room.
void Compressible::find_results(FluidFraction& f) {
  boundaries_.fill(w_);
  const std::array<ConstFieldView, 3> u{w_[kU].view(), w_[kV].view(), w_[kW].view()};
  find_undisplaced(grid_, w_[kP].view(), u, turbulent() ? eddy_viscosity_.view() : ConstFieldView{},
                   options_.viscosity, 1.0 / grains_->density(), f);
}

void Compressible::book_grains(const FluidFraction& f, double dt) {
  const bool room = in_room_ > 0.0;
  const TakenByGrains taken = taken_by_grains(grid_, f, Vec3(0, 0, 0), room ? ConstFieldView{} : part());
  ledger().momentum_of_solids -= dt * grains_->density() * taken.force;
  ledger().work_of_solids -= grains_->energy_taken(f, middle_, room, part());
}

void Compressible::resume() {
  cut_gas_.resume();
  part_ = in_room_ > 0.0 ? &grains_->part() : &cut_gas_.carried();
}

std::vector<NamedField> Compressible::state() {
  std::vector<NamedField> fields = GasFlow::state();
  fields.push_back({"pressure_change", &acoustic_.change()});
  fields.push_back({"carried", &cut_gas_.carried()});
  if (grains_) fields.push_back({"part", &grains_->part()});
  return fields;
}

}  // namespace ejecta::gas
