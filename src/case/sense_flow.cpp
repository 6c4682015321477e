#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/units.hpp"
#include "case/extent.hpp"
#include "case/findings.hpp"
#include "case/schema.hpp"

/// Run, fluid, grid.
namespace ejecta {
namespace {

bool has_flow(const Case& c) { return c.flow.solver != FlowSolver::none; }
std::string axis_key(std::size_t a) { return std::string("grid.") + axis_names[a]; }

}  // namespace

void sense_run(const Case& c, Findings& found) {
  if (!has_flow(c) && c.bodies.empty() && c.grains.empty())
    found.error("flow.solver", "neither a flow nor a body nor grains: there is nothing to compute",
                "a flow solver, or at least one [[body]]", "solver = \"incompressible\"");
  if (c.run.until != RunUntil::time && c.bodies.empty() && !c.sorter.enabled)
    found.error("run.until", fmt::format("until \"{}\" needs a body", word(c.run.until)),
                "\"time\", or at least one [[body]]", "until = \"time\"");
  if (c.run.until == RunUntil::verdict && !c.splitter.enabled)
    found.error("run.until", "a verdict needs the dividing plate", "a section [splitter]", "[splitter]");
  if (c.run.until == RunUntil::verdict && !c.bodies.empty() &&
      std::all_of(c.bodies.begin(), c.bodies.end(),
                  [](const BodySpec& b) { return b.motion == Motion::fixed; }))
    found.error("run.until", "a verdict needs a body that moves: all are \"fixed\"",
                "\"time\", or a free body", "until = \"time\"");
  if (c.run.time_step && *c.run.time_step > c.run.end_time)
    found.error("run.time_step",
                fmt::format("a step of {} is longer than the run",
                            format_quantity(*c.run.time_step, Dimension::time)),
                "a step shorter than run.end_time", "time_step = \"10 us\"");
  const double most = is_incompressible(c) ? 2.0 : 1.0;
  if (has_flow(c) && !c.run.time_step && c.run.courant > most)
    found.error("run.courant",
                fmt::format("the explicit transport of the {} solver cannot hold a Courant number of {}",
                            word(c.flow.solver), c.run.courant),
                fmt::format("at most {}", most), "courant = 1");

  if (!has_flow(c)) return;
  if (c.flow.solver == FlowSolver::compressible && !c.bodies.empty())
    found.error("flow.solver", "\"compressible\" computes the air alone, not what it does to bodies",
                "\"incompressible\" or \"compressible-piso\"", "solver = \"compressible-piso\"");
  if (!is_incompressible(c) && !c.flow.body_force.isZero())
    found.error("flow.body_force", "the compressible solvers know no force on the gas",
                "no body_force, or an incompressible flow", "solver = \"incompressible\"");
  if (!c.fluid.ideal_gas && c.fluid.density <= 0.0)
    found.error("fluid.density", "a fluid that is no ideal gas needs its density", "a density, more than 0",
                "density = \"998 kg/m3\"");
  if (!c.fluid.ideal_gas && !is_incompressible(c))
    found.error("fluid.ideal_gas", "the compressible solvers compute ideal gases only",
                "true, or an incompressible flow", "ideal_gas = true");
  const double ideal = c.environment.pressure / (c.fluid.gas_constant * c.environment.temperature);
  if (c.fluid.ideal_gas && std::abs(c.fluid.density - ideal) > 0.01 * ideal)
    found.error("fluid.density",
                fmt::format("{} kg/m3 is not p/(R T) of the environment, which is {:.4g} kg/m3",
                            c.fluid.density, ideal),
                "no density for an ideal gas, or ideal_gas = false", "ideal_gas = false");
  if (c.flow.turbulence != TurbulenceModel::laminar && c.fluid.viscosity == 0.0)
    found.error("fluid.viscosity", "a turbulence model needs a viscosity", "a dynamic viscosity, more than 0",
                "viscosity = \"1.85e-5 Pa s\"");
}

void sense_grid(const Case& c, Findings& found) {
  if (!has_flow(c)) return;
  double cells = 1.0;
  for (std::size_t a = 0; a < 3; ++a) {
    const AxisSpec& axis = c.grid.axis[a];
    const std::string key = axis_key(a);
    if (axis.points.size() < 2 || axis.cells.empty()) {
      found.error(key, "the flow has no cells along this axis",
                  fmt::format("a section [{}] with points and cells", key),
                  fmt::format("[{}] points = [\"-50 mm\", \"50 mm\"], cells = [100]", key));
      continue;
    }
    if (axis.cells.size() + 1 != axis.points.size())
      found.error(key + ".cells",
                  fmt::format("{} points bound {} blocks, but there are {} numbers of cells",
                              axis.points.size(), axis.points.size() - 1, axis.cells.size()),
                  "one number of cells for each block",
                  "points = [\"0 mm\", \"20 mm\", \"50 mm\"], cells = [40, 30]");
    if (!axis.grading.empty() && axis.grading.size() != axis.cells.size())
      found.error(key + ".grading",
                  fmt::format("{} gradings for {} blocks", axis.grading.size(), axis.cells.size()),
                  "one grading for each block, or none", "cells = [40, 30], grading = [1, 4]");
    for (std::size_t i = 1; i < axis.points.size(); ++i)
      if (!(axis.points[i] > axis.points[i - 1])) {
        found.error(
            key + ".points",
            fmt::format("{} does not come after {}", format_quantity(axis.points[i], Dimension::length),
                        format_quantity(axis.points[i - 1], Dimension::length)),
            "points in ascending order", "points = [\"-50 mm\", \"0 mm\", \"50 mm\"]");
        break;
      }
    double along = 0.0;
    for (int n : axis.cells) along += n;
    cells *= along;
  }
  if (cells > 2e9)
    found.error("grid", fmt::format("{:.3g} cells: no machine this program runs on holds them", cells),
                "at most 2e9 cells", "[grid.x] cells = [80]");
  if (c.grid.geometry != Geometry::axisymmetric) return;
  if (!c.grid.axis[0].points.empty() && c.grid.axis[0].points.front() < 0.0)
    found.error("grid.x.points", "in axisymmetric geometry x is the radius and cannot be negative",
                "points from 0 on", "points = [\"0 mm\", \"50 mm\"]");
  if (c.grid.axis[1].cells != std::vector<int>{1})
    found.error("grid.y.cells", "axisymmetric geometry has one cell around", "cells = [1]", "cells = [1]");
  if (!c.bodies.empty())
    found.error("body.0", "axisymmetric geometry cannot hold bodies", "cartesian geometry",
                "geometry = \"cartesian\"");
}

}  // namespace ejecta
