#include "jet/settled.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "jet/momentum.hpp"

namespace ejecta {
namespace {

constexpr double kPenetration = 3.0;  // Gamma of a starting round jet
constexpr double kArrivals = 4.0;
constexpr double kOpening = 0.2e-3;  ///< s, within which the valve opens: sooner, and the box rings
constexpr double kLook = 5e-6;       ///< s, between two looks at the momentum

/// Time the head of a jet of `momentum` (N) needs to `height`, s.
double arrival(double momentum, double density, double height) {
  return std::pow(height / kPenetration, 2) / std::sqrt(momentum / density);
}

/// Of the air that blows forward through a plane, N.
double jet_momentum(const JetModel& jet, double height) {
  const Metrics x = jet.grid().metrics(0), y = jet.grid().metrics(1);
  double sum = 0.0;
  for (int j = 0; j < jet.grid().ny(); ++j)
    for (int i = 0; i < jet.grid().nx(); ++i) {
      Vec3 at = jet.grid().centre(i, j, 0);
      at.z() = jet.grid().lower().z() + height;
      const JetSample s = jet.sample(at);
      const double w = std::max(0.0, s.velocity.z());
      sum += double(x.volume[i]) * double(y.volume[j]) * s.density * w * w;
    }
  return jet.whole_jet() * sum;
}

Case blown(Case c, double time) {
  ValveSpec& v = c.valve;
  v.shape = ValveShape::smooth;
  v.opens_at = v.delay = v.fall_time = 0.0;
  v.rise_time = kOpening;
  v.duration = c.run.end_time = kOpening + time;
  v.more_pulses.clear();
  return c;
}

}  // namespace

Case incompressible_jet(Case c, double velocity) {
  c.flow.solver = FlowSolver::incompressible;
  c.jet.kind = JetKind::velocity_inlet;
  c.jet.inlet_velocity = velocity;
  return c;
}

std::optional<SettledJet> settled_jet(const Case& c, double height, const Note& note,
                                      const std::function<bool()>& stop) {
  const Gas gas{c.fluid.gamma, c.fluid.gas_constant};
  const double warm =
      c.valve.supply_temperature > 0.0 ? c.valve.supply_temperature : c.environment.temperature;
  const NozzleExit exit = nozzle_exit(gas, c.valve.supply_pressure, warm, c.environment.pressure);
  const double blown_at = c.flow.solver == FlowSolver::incompressible ? c.jet.inlet_velocity : 0.0;
  const double head =
      arrival(blown_at > 0.0 ? c.fluid.density * c.valve.discharge_coefficient *
                                   nozzle_area(c.valve.orifice_diameter) * blown_at * blown_at
                             : nozzle_thrust(exit, c.valve.discharge_coefficient, c.valve.orifice_diameter),
              c.fluid.density, height);
  SettledJet s{.scenario = blown(c, kArrivals * head)};
  s.equivalent_velocity = nozzle_equivalent_velocity(exit, 1.0, c.fluid.density);
  JetModel jet(s.scenario);
  MomentumRecord momentum(jet);
  const double end = s.scenario.run.end_time;
  double unseen = 0.0;
  // The valve shuts at the end: what is looked at is the last moment before.
  Clock clock = jet.clock();
  for (Step step; jet.time() + step.dt < end;) {
    if (stop && stop()) return std::nullopt;
    step = jet.step(clock);
    if (jet.time() < end - head || (unseen += step.dt) < kLook) continue;
    momentum.observe(jet, unseen);
    unseen = 0.0;
  }
  s.time = jet.time();
  s.steps = clock.steps();
  s.line = centreline(jet);
  s.heights = momentum.heights();
  s.momentum = momentum.mean();
  s.thrust = momentum.thrust();
  s.momentum_summary = momentum.summary();
  s.at_stand_off = jet.sample(jet.grid().lower() + Vec3(0, 0, c.launch.stand_off));
  s.momentum_at_stand_off = jet_momentum(jet, c.launch.stand_off);
  if (note)
    note(fmt::format(
        "{}: {:.3f} ms, {} steps, {:.0f} m/s and {:.2f} kPa on the axis at {:.0f} mm",
        c.flow.solver == FlowSolver::compressible
            ? fmt::format("compressible, {:.0f} kPa gauge",
                          1e-3 * (c.valve.supply_pressure - c.environment.pressure))
            : fmt::format("incompressible, {:.0f} m/s",
                          c.jet.inlet_velocity > 0.0 ? c.jet.inlet_velocity : s.equivalent_velocity),
        1e3 * s.time, s.steps, s.at_stand_off.velocity.z(), 1e-3 * s.at_stand_off.total_gauge,
        1e3 * c.launch.stand_off));
  return s;
}

double where_square_reaches(const std::vector<double>& x, const std::vector<double>& y, double wanted) {
  const auto above = std::lower_bound(y.begin(), y.end(), wanted);
  if (above == y.begin()) return x.front() * std::sqrt(wanted / y.front());
  if (above == y.end()) return x.back() * std::sqrt(wanted / y.back());
  const auto n = static_cast<std::size_t>(above - y.begin());
  const double share = (wanted - y[n - 1]) / (y[n] - y[n - 1]);
  return std::sqrt((1.0 - share) * x[n - 1] * x[n - 1] + share * x[n] * x[n]);
}

}  // namespace ejecta
