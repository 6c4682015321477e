#include "simulation/forecast.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "base/parallel.hpp"
#include "case/copies.hpp"
#include "case/expression.hpp"
#include "case/load.hpp"
#include "dem/course.hpp"
#include "flow/ideal_gas.hpp"
#include "grid/grid.hpp"
#include "jet/source.hpp"
#include "simulation/air_forecast.hpp"

namespace ejecta {
namespace {

bool has_flow(const Case& c) { return c.flow.solver != FlowSolver::none; }
bool is_compressible(const Case& c) {
  return c.flow.solver == FlowSolver::compressible || c.flow.solver == FlowSolver::compressible_piso;
}

Grid grid_of(const Case& c) {
  const auto axis = [&](std::size_t a) {
    return make_axis(c.grid.axis[a].points, c.grid.axis[a].cells, c.grid.axis[a].grading);
  };
  return Grid(axis(0), axis(1), axis(2), c.grid.geometry == Geometry::axisymmetric);
}

Gas gas_of(const Case& c) { return {.gamma = c.fluid.gamma, .gas_constant = c.fluid.gas_constant}; }

/// Speed of sound of a state at the start, m/s; what it does not say is ambient.
double sound_speed(const Case& c, const StateSpec& s, const Vec3& at) {
  const auto value = [&](const std::optional<std::string>& text, double ambient) {
    return text ? Expression(*text)(at[0], at[1], at[2], 0.0) : ambient;
  };
  const Gas gas = gas_of(c);
  const double pressure = value(s.pressure, c.environment.pressure);
  const double temperature = s.density ? pressure / (gas.gas_constant * value(s.density, c.fluid.density))
                                       : value(s.temperature, c.environment.temperature);
  return gas_sound_speed(gas, temperature);
}

/// Largest speed at which a state carries anything over the run, sampled at one point, m/s: |u|, and sound
/// where the solver follows it.
double fastest_state(const Case& c, const StateSpec& s, const Vec3& at) {
  constexpr int samples = 64;
  double fastest = 0.0;
  for (int n = 0; s.velocity && n <= samples; ++n) {
    Vec3 u;
    for (int a = 0; a < 3; ++a)
      u[a] = Expression((*s.velocity)[static_cast<std::size_t>(a)])(at[0], at[1], at[2],
                                                                    c.run.end_time * n / samples);
    fastest = std::max(fastest, u.norm());
  }
  return fastest + (c.flow.solver == FlowSolver::compressible ? sound_speed(c, s, at) : 0.0);
}

/// Gas expanded into a vacuum, sqrt(2 cp T0), m/s: no steady jet from a reservoir of temperature T0 is
/// faster.
double limiting_speed(const Gas& gas, double total_temperature) {
  return std::sqrt(2.0 * gas.specific_heat_pressure() * total_temperature);
}

/// Gas at rest behind a boundary, or behind the orifice of a valve.
bool has_reservoir(const Case& c) {
  return std::any_of(c.boundary.begin(), c.boundary.end(), [](const BoundarySpec& b) {
    return b.type == BoundaryType::total_pressure ||
           std::any_of(b.patches.begin(), b.patches.end(), [](const PatchSpec& p) {
             return p.type == BoundaryType::total_pressure || p.type == BoundaryType::jet;
           });
  });
}

double fastest_speed(const Case& c, const Grid& grid) {
  const Vec3 centre = 0.5 * (grid.lower() + grid.upper());
  if (is_compressible(c) && has_reservoir(c))
    return limiting_speed(gas_of(c), std::max(c.valve.supply_temperature, c.environment.temperature));
  const double sound = c.flow.solver == FlowSolver::compressible ? sound_speed(c, StateSpec{}, centre) : 0.0;
  double fastest = has_flow(c) && has_jet(c) ? jet_speed(c) + sound : 0.0;
  for (const BoundarySpec& face : c.boundary) {
    if (face.state.velocity) fastest = std::max(fastest, fastest_state(c, face.state, centre));
    for (const PatchSpec& patch : face.patches)
      fastest = std::max(fastest, fastest_state(c, patch.state, patch.centre));
  }
  for (const InitialSpec& region : c.initial)
    fastest = std::max(
        fastest,
        fastest_state(c, region.state, region.box ? 0.5 * ((*region.box)[0] + (*region.box)[1]) : centre));
  if (c.initial.empty()) fastest = std::max(fastest, fastest_state(c, StateSpec{}, centre));
  for (const BodySpec& b : c.bodies)
    fastest = std::max(fastest, b.motion == Motion::prescribed
                                    ? make_course(b, folder_of(c))->pace(c.run.end_time).speed.norm()
                                    : b.velocity.norm());
  return fastest;
}

/// Numbers a cell holds, and numbers it moves through memory in a step. Measured: boxes of 0.6 and 4.6
/// million cells hold 26 (laminar) or 40 numbers a cell and its ghosts, of compressible gas 62; the paper's
/// box of 571,200 cells with k-epsilon takes 50 ms a step on a core that moves 22 GB/s.
struct CellCost {
  int held;
  double moved;
};

CellCost cell_cost(const Case& c) {
  const bool laminar = c.flow.turbulence == TurbulenceModel::laminar;
  if (is_compressible(c)) return {62, laminar ? 540.0 : 660.0};
  return laminar ? CellCost{26, 360.0} : CellCost{40, 480.0};
}

/// What grains add, of the same kind: the pressure equation is iterated where they leave no room for the
/// fluid, and each grain costs its motion and a share of every cell it is mapped on. Measured: 100,000 grains
/// of 0.15 mm (five cells each) in 571,200 cells, and 200,000 of 0.5 mm (216 each).
constexpr double kIteratedPressure = 2.5, kNumbersOfGrain = 6000.0, kNumbersOfGrainInCell = 100.0;

constexpr double kStateFields = 10.0;  ///< in a checkpoint: velocity, face velocities, pressure, turbulence

double count_of(double interval, double end) {
  return interval > 0.0 ? std::floor(end / interval) + 1.0 : 0.0;
}

double disk_space(const Case& c, const Grid& grid, const Forecast& f) {
  const double cells = static_cast<double>(grid.cells()),
               all = c.flow.turbulence == TurbulenceModel::laminar ? 4.0 : 7.0;
  // Numbers a cell: a vector stands for two more.
  const double numbers = c.output.fields.empty() ? all : static_cast<double>(c.output.fields.size()) + 2.0;
  const double slices = count_of(c.output.slices_interval, f.air_until);
  double bytes = count_of(c.output.fields_interval, f.air_until) * cells * numbers * sizeof(float);
  for (const SliceSpec& s : c.slices) bytes += slices * cells / grid.n(s.axis) * numbers * sizeof(float);
  constexpr double row = 400.0, cell_of_row = 20.0;  // text
  for (const LineSpec& l : c.lines) bytes += slices * l.points * (numbers + 3.0) * cell_of_row;
  const double rows = c.output.history_interval > 0.0 ? count_of(c.output.history_interval, c.run.end_time)
                                                      : static_cast<double>(f.steps);
  bytes += rows * row * static_cast<double>(c.bodies.size() + c.probes.size() + 1);
  // The page itself, and each frame in the replay and once more in the page.
  constexpr double page = 0.7e6, frame = 13e3;
  if (c.output.report) bytes += page + 2.0 * frame * (c.output.slices_interval > 0.0 ? slices : 200.0);
  const bool checkpoints =
      c.checkpoint.every_steps > 0 || c.checkpoint.every_time > 0.0 || c.checkpoint.every_wall_time > 0.0;
  return bytes + (checkpoints ? 2.0 * cells * kStateFields * sizeof(Real) : 0.0);  // the last two are kept
}

/// Inverse of the longest step of the explicit viscous terms, 2 nu sum 1/h2, 1/s; with a turbulence model,
/// whose eddies are more viscous and whose increments are smoothed, none.
double viscous_rate(const Case& c, const Grid& grid) {
  if (c.flow.turbulence != TurbulenceModel::laminar) return 0.0;
  double sum = 0.0;
  for (int d = 0; d < 3; ++d)
    if (grid.active(d)) sum += std::pow(grid.axis(d).smallest(), -2);
  return 2.0 * c.fluid.viscosity / c.fluid.density * sum;
}

}  // namespace

Forecast forecast(const Case& c) { return forecast(c, company_of(with_first_copies(c))); }

Forecast forecast(const Case& c, const Company& company) {
  Forecast f;
  f.time_step = c.run.time_step.value_or(c.run.time_step_max);
  f.air_until = air_until(c, company);
  if (!has_flow(c)) return f;
  const Grid grid = grid_of(c);
  f.cells = grid.cells();
  f.smallest_volume = grid.smallest_volume();
  f.largest_volume = grid.largest_volume();
  f.smallest_cell = 1e300;
  for (int d = 0; d < 3; ++d) {
    if (!grid.active(d)) continue;
    f.smallest_cell = std::min(f.smallest_cell, grid.axis(d).smallest());
    f.largest_cell = std::max(f.largest_cell, grid.axis(d).largest());
  }
  f.fastest = fastest_speed(c, grid);
  const double convection = f.fastest / (c.run.courant * f.smallest_cell), viscosity = viscous_rate(c, grid);
  if (!c.run.time_step && convection + viscosity > 0.0)
    f.time_step = std::min(c.run.time_step_max, 1.0 / (convection + viscosity));
  f.by_viscosity = viscosity > convection && f.time_step < c.run.time_step_max;
  f.knows_step = c.run.time_step || f.fastest > 0.0 || f.by_viscosity;
  f.steps = c.run.time_step || !has_jet(c) || is_compressible(c)
                ? static_cast<std::int64_t>(std::max(1.0, std::ceil(f.air_until / f.time_step)))
                : jet_steps(c, grid, f.air_until);
  double held = 1.0;  // cells with two layers of ghosts
  for (int d = 0; d < 3; ++d) held *= grid.n(d) + 4;
  f.memory = 26e6 + held * cell_cost(c).held * sizeof(Real);
  f.disk = disk_space(c, grid, f);
  return f;
}

double expected_seconds(const Case& c, const Forecast& f, double bandwidth, std::span<const Body> grains) {
  const double corrections = c.flow.solver == FlowSolver::incompressible ? 0.5 * c.flow.corrections : 1.0;
  double moved = static_cast<double>(f.cells) * cell_cost(c).moved * corrections;
  if (!grains.empty() && c.coupling.exchange == GrainExchange::two_way) moved *= kIteratedPressure;
  for (const Body& grain : grains) {
    const double width = 2.0 * c.coupling.kernel_width * grain.shape.bounding_radius(),
                 cells = std::pow(1.0 + width / std::cbrt(f.smallest_volume), 3);
    moved += kNumbersOfGrain + kNumbersOfGrainInCell * cells;
  }
  return static_cast<double>(f.steps) * moved * sizeof(Real) / bandwidth;
}

double measured_bandwidth() {
  const int n = 1 << 23;
  std::vector<float> a(static_cast<std::size_t>(n), 1.0f), b(a.size(), 2.0f);
  constexpr int chunk = 1 << 16, repeats = 8;
  float* to = a.data();
  const float* from = b.data();
  const auto start = std::chrono::steady_clock::now();
  for (int r = 0; r < repeats; ++r)
    for_each_index(n / chunk, [=](int k) {
      for (int i = k * chunk; i < (k + 1) * chunk; ++i) to[i] = to[i] + 0.5f * from[i];
    });
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return 3.0 * sizeof(float) * n * repeats / seconds;
}

}  // namespace ejecta
