#include "jet/model.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.hpp"
#include "flow/model/flow_model.hpp"

namespace ejecta {
namespace {

PatchSpec orifice_of(const Case& c) {
  for (const PatchSpec& p : c.boundary[4].patches)
    if (p.type == BoundaryType::jet) return p;
  throw InputError(
      "the case has no orifice: give [[boundary.z_min.patch]] with type = \"jet\" and its radius");
}

}  // namespace

const Case& require_jet_case(const Case& c) {
  const PatchSpec orifice = orifice_of(c);
  const double flowing = 0.5 * c.valve.orifice_diameter * std::sqrt(c.valve.discharge_coefficient);
  if (std::abs(orifice.radius - flowing) > 1e-3 * flowing)
    throw InputError(fmt::format(
        "boundary.z_min.patch.0.radius is {:.4g} mm, but what flows through valve.orifice_diameter = {:.4g} "
        "mm with "
        "valve.discharge_coefficient = {:.3g} is a disc of radius {:.4g} mm",
        1e3 * orifice.radius, 1e3 * c.valve.orifice_diameter, c.valve.discharge_coefficient, 1e3 * flowing));
  require_jet_air(c);
  return c;
}

JetModel::JetModel(const Case& c)
    : case_(require_jet_case(c)),
      grid_(make_grid(c)),
      drive_(case_),
      gas_{c.fluid.gamma, c.fluid.gas_constant},
      orifice_(orifice_of(c)),
      air_(make_jet_air(case_, grid_)) {
  if (grid_.axisymmetric()) whole_jet_ = 2.0 * std::numbers::pi;
  for (int d = 0; d < 2; ++d)
    if (!grid_.axisymmetric() && grid_.active(d) && std::abs(grid_.lower()[d] - orifice_.centre[d]) < 1e-9)
      whole_jet_ *= 2.0;
}

double JetModel::cells_across_orifice() const {
  const double width =
      grid_.axis(0).width[static_cast<std::size_t>(grid_.axis(0).cell_at(orifice_.centre.x()))];
  return 2.0 * orifice_.radius / width;
}

double JetModel::stable_dt(double time) {
  const double dt = std::min(air_->stable_dt(time), case_.run.time_step_max);
  return case_.run.time_step.value_or(dt);
}

void JetModel::advance(const Step& step) {
  air_->advance(step.from, step.dt);
  time_ = step.to;
}

Clock JetModel::clock() const {
  Clock clock;
  for (const double t : valve().events()) clock.add_event(t);
  clock.add_event(case_.run.end_time);
  return clock;
}

Step JetModel::step(Clock& clock) {
  const Step step = clock.next(stable_dt(clock.time()));
  advance(step);
  clock.tick(step);
  return step;
}

void JetModel::restore(std::span<const double> numbers, double time) {
  air_->restore_numbers(numbers, time);
  time_ = time;
}

JetSample JetModel::sample(const Vec3& position) const {
  JetSample s{air_->at(position)};
  const bool incompressible = case_.flow.solver == FlowSolver::incompressible;
  s.temperature =
      incompressible ? case_.environment.temperature : s.pressure / (s.density * gas_.gas_constant);
  const double sound = gas_sound_speed(gas_, s.temperature), w = std::max(0.0, s.velocity.z());
  s.mach = s.velocity.norm() / sound;
  if (incompressible) {
    s.total_gauge = s.pitot_gauge = s.pressure + 0.5 * s.density * w * w - ambient_pressure();
    return s;
  }
  const double axial = w / sound;
  s.total_gauge = s.pressure * gas_total_pressure_ratio(gas_, axial) - ambient_pressure();
  s.pitot_gauge = s.pressure * gas_pitot_ratio(gas_, axial) - ambient_pressure();
  return s;
}

JetFlow JetModel::through(int k) const { return sum_flow(k, std::numeric_limits<double>::infinity()); }

JetFlow JetModel::orifice_flow() const { return sum_flow(0, orifice_.radius); }

JetFlow JetModel::sum_flow(int k, double within) const {
  const Metrics x = grid_.metrics(0), y = grid_.metrics(1);
  JetFlow sum;
  for (int j = 0; j < grid_.ny(); ++j)
    for (int i = 0; i < grid_.nx(); ++i) {
      const Vec3 from_axis = grid_.centre(i, j, 0) - orifice_.centre;
      const double radius = grid_.axisymmetric() ? from_axis.x() : std::hypot(from_axis.x(), from_axis.y());
      if (radius > within) continue;
      const double area = double(x.volume[i]) * double(y.volume[j]);
      const JetFlow flux = air_->flux(i, j, k);
      sum.mass += area * flux.mass;
      sum.momentum += area * flux.momentum;
    }
  return {whole_jet_ * sum.mass, whole_jet_ * sum.momentum};
}

}  // namespace ejecta
