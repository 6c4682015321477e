#include "app/jet_model.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "app/flow_model.hpp"
#include "app/grid_sampler.hpp"
#include "base/error.hpp"

namespace ejecta {
namespace {

constexpr double kFewestAcross = 8.0;  ///< cells across the orifice below which its jet means nothing

}  // namespace

JetModel::JetModel(const Case& c)
    : case_(c), grid_(make_grid(c)), drive_(c), gas_{c.fluid.gamma, c.fluid.gas_constant} {
  if (c.flow.solver != FlowSolver::compressible)
    throw InputError("a jet is computed from its nozzle with flow.solver = \"compressible\"");
  solver_ = godunov::solver_from_case(c, grid_, inlets_);
  if (inlets_.empty())
    throw InputError(
        "the case has no orifice: give [[boundary.z_min.patch]] with type = \"jet\" and its radius");
  if (cells_across_orifice() < kFewestAcross)
    throw InputError(
        fmt::format("the nozzle is not resolved: {:.1f} cells across the orifice of {:.3g} mm, at least "
                    "{:.0f} are needed; "
                    "refine grid.x near the axis",
                    cells_across_orifice(), 1e3 * orifice_diameter(), kFewestAcross));
  if (valve().closed_from() > c.run.end_time && valve().events().front() < c.run.end_time &&
      c.valve.opens_at + c.valve.delay + c.valve.duration > c.run.end_time && c.run.end_time > 0.0)
    throw InputError(
        fmt::format("the pulse ends at {:.4g} ms, after the simulated time run.end_time of {:.4g} ms",
                    1e3 * (c.valve.opens_at + c.valve.delay + c.valve.duration), 1e3 * c.run.end_time));
  const double flowing = 0.5 * orifice_diameter() * std::sqrt(c.valve.discharge_coefficient);
  if (std::abs(inlets_[0].radius - flowing) > 1e-3 * flowing)
    throw InputError(fmt::format(
        "boundary.z_min.patch.0.radius is {:.4g} mm, but what flows through valve.orifice_diameter = {:.4g} "
        "mm with "
        "valve.discharge_coefficient = {:.3g} is a disc of radius {:.4g} mm",
        1e3 * inlets_[0].radius, 1e3 * orifice_diameter(), c.valve.discharge_coefficient, 1e3 * flowing));
  for (int d = 0; d < 2; ++d)
    if (!grid_.axisymmetric() && grid_.active(d) && std::abs(grid_.lower()[d] - inlets_[0].centre[d]) < 1e-9)
      fold_ *= 2.0;
  for (const double t : valve().events()) clock_.add_event(t);
  clock_.add_event(c.run.end_time);
}

double JetModel::cells_across_orifice() const {
  const double width =
      grid_.axis(0).width[static_cast<std::size_t>(grid_.axis(0).cell_at(inlets_[0].centre.x()))];
  return 2.0 * inlets_[0].radius / width;
}

double JetModel::step() {
  double dt = std::min(solver_->stable_dt(case_.run.courant), case_.run.time_step_max);
  if (case_.run.time_step) dt = *case_.run.time_step;
  dt = clock_.land_on_events(dt);
  drive_.apply(time() + 0.5 * dt, *solver_, inlets_);
  solver_->advance(dt);
  clock_.tick(dt);
  return dt;
}

JetSample JetModel::sample(const Vec3& position) const {
  const GridSampler at(grid_, position);
  const godunov::Block& w = solver_->primitive();
  const auto value = [&](int c) { return at(w[static_cast<std::size_t>(c)].view()); };
  JetSample s;
  s.density = value(godunov::kRho);
  s.velocity = {value(godunov::kU), grid_.axisymmetric() ? 0.0 : value(godunov::kV), value(godunov::kW)};
  s.pressure = value(godunov::kP) + solver_->options().reference_pressure;
  s.temperature = s.pressure / (s.density * gas_.gas_constant);
  const double sound = gas_sound_speed(gas_, s.temperature);
  s.mach = s.velocity.norm() / sound;
  s.k = value(godunov::kK);
  s.epsilon = value(godunov::kE);
  if (case_.flow.turbulence == TurbulenceModel::k_omega_sst) s.epsilon *= 0.09 * s.k;
  const double axial = std::max(0.0, s.velocity.z()) / sound;
  s.total_gauge = s.pressure * gas_total_pressure_ratio(gas_, axial) - ambient_pressure();
  s.pitot_gauge = s.pressure * gas_pitot_ratio(gas_, axial) - ambient_pressure();
  return s;
}

JetFlow JetModel::through(int k) const { return sum_flow(k, std::numeric_limits<double>::infinity()); }

JetFlow JetModel::orifice_flow() const { return sum_flow(0, inlets_[0].radius); }

JetFlow JetModel::sum_flow(int k, double within) const {
  const Metrics x = grid_.metrics(0), y = grid_.metrics(1);
  const godunov::Block& flux = solver_->flux(2);
  JetFlow sum;
  for (int j = 0; j < grid_.ny(); ++j)
    for (int i = 0; i < grid_.nx(); ++i) {
      const Vec3 from_axis = grid_.centre(i, j, 0) - inlets_[0].centre;
      const double radius = grid_.axisymmetric() ? from_axis.x() : std::hypot(from_axis.x(), from_axis.y());
      if (radius > within) continue;
      const double area = double(x.volume[i]) * double(y.volume[j]);
      sum.mass += area * double(flux[godunov::kRho](i, j, k));
      sum.momentum += area * double(flux[godunov::kW](i, j, k));
    }
  const double around = grid_.axisymmetric() ? 2.0 * std::numbers::pi : fold_;
  return {around * sum.mass, around * sum.momentum};
}

}  // namespace ejecta
