#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/units.hpp"
#include "case/extent.hpp"
#include "case/findings.hpp"
#include "case/load.hpp"

/// Valve, jet, launch, splitter.
namespace ejecta {
namespace {

bool has_jet(const Case& c) { return c.flow.solver != FlowSolver::none && jet_face(c); }

/// Pa gauge; a sorter's valves blow with 2 to 10 bar.
constexpr double kLeastSupply = 10e3, kMostSupply = 4e6;

/// Cells across the orifice below which its jet means nothing
constexpr double kFewestAcross = 8.0;

/// What a jet computed from its orifice needs.
void check_orifice(const Case& c, Findings& found) {
  const ValveSpec& v = c.valve;
  const double closes = v.opens_at + v.delay + v.duration;
  if (v.shape != ValveShape::trace && closes > c.run.end_time)
    found.error(
        "valve.duration",
        fmt::format("the pulse is longer than the simulated time: it ends at {:.4g} ms, the run at {:.4g} ms",
                    1e3 * closes, 1e3 * c.run.end_time),
        "a pulse that ends before run.end_time", fmt::format("[run] end_time = \"{:.4g} ms\"", 1e3 * closes));
  const AxisSpec& x = c.grid.axis[0];
  for (std::size_t n = 0; n < c.boundary[4].patches.size(); ++n) {
    const PatchSpec& p = c.boundary[4].patches[n];
    if (p.type != BoundaryType::jet || x.points.size() != x.cells.size() + 1) continue;
    const double across = 2.0 * p.radius / widest_cell(x, p.centre.x(), p.centre.x() + 0.9 * p.radius);
    if (across < kFewestAcross)
      found.error(fmt::format("boundary.z_min.patch.{}.radius", n),
                  fmt::format("the nozzle is not resolved: {:.1f} cells across an orifice of {:.3g} mm",
                              across, 2e3 * p.radius),
                  fmt::format("at least {:.0f} cells across it, better 16: finer [grid.x] near the axis",
                              kFewestAcross),
                  "[grid.x] points = [\"0 mm\", \"0.9 mm\", \"70 mm\"], cells = [8, 60], grading = [1, 40]");
  }
}

std::string ms(double seconds) { return fmt::format("{:.3g} ms", 1e3 * seconds); }

/// Where the orifices stand and whither they blow.
void check_placing(const Case& c, Findings& found) {
  const bool up = c.jet.direction.x() == 0.0 && c.jet.direction.y() == 0.0 && c.jet.direction.z() > 0.0;
  if (c.grid.geometry == Geometry::axisymmetric && !(up && c.jet.more_nozzles.empty()))
    found.error(up ? "jet.more_nozzles" : "jet.direction",
                "in axisymmetric geometry one jet blows along its axis, +z", "neither of the two, or a box",
                "direction = [0, 0, 1]");
  if (c.launch.enabled && !up)
    found.error("jet.direction", "the belt throws bodies over a jet that blows upwards", "no [launch], or +z",
                "direction = [0, 0, 1]");
  if (!grid_box(c)) return;
  Case other = c;
  for (const Vec3& nozzle : c.jet.more_nozzles) {
    other.jet.nozzle = nozzle;
    const Vec3 along = c.jet.direction.normalized();
    const Vec3 in_plane = nozzle - along.dot(nozzle - c.jet.nozzle) * along;
    if (std::abs(jet_height(other) - jet_height(c)) > 1e-6 * std::abs(jet_height(c)) + 1e-9)
      found.error("jet.more_nozzles", "the orifices are not at one distance from the face", "one plane",
                  fmt::format("more_nozzles = [{}]", place_text(in_plane)));
  }
  if (c.jet.kind == JetKind::computed && jet_height(c) <= 0.0)
    found.error("jet.nozzle", "the face through which the jet enters does not lie ahead of its orifice",
                "an orifice outside of the box, behind that face",
                "nozzle = [\"0 mm\", \"0 mm\", \"-40 mm\"]");
  if (c.jet.kind == JetKind::velocity_inlet &&
      c.jet.direction.cwiseAbs().maxCoeff() < (1.0 - 1e-9) * c.jet.direction.norm())
    found.error("jet.direction", "an orifice in the face itself blows along the face's normal",
                "the normal, or another jet.kind", "direction = [0, 0, 1]");
}

}  // namespace

void sense_sorter(const Case& c, Findings& found) {
  const ValveSpec& v = c.valve;
  if (v.shape == ValveShape::trace)
    require_file(c, "valve.trace", v.trace, "the shape \"trace\" needs its file", "trace = \"opening.csv\"",
                 found);
  if (has_jet(c)) {
    if (v.shape != ValveShape::trace && v.duration <= 0.0)
      found.error("valve.duration", "the valve never opens", "a time, more than 0", "duration = \"8 ms\"");
    if (v.opens_at + v.delay >= c.run.end_time)
      found.error(v.opens_at < c.run.end_time ? "valve.delay" : "valve.opens_at",
                  fmt::format("the valve never opens: the run ends at {}, before it moves at {}",
                              ms(c.run.end_time), ms(v.opens_at + v.delay)),
                  "a time before run.end_time",
                  v.opens_at < c.run.end_time ? "delay = \"0 ms\"" : "opens_at = \"0 ms\"");
    if (v.supply_pressure <= c.environment.pressure)
      found.error("valve.supply_pressure", "the supply is not above the ambient pressure: nothing flows",
                  "more than ambient", "supply_pressure = \"700 kPa gauge\"");
    const double gauge = v.supply_pressure - c.environment.pressure;
    if (gauge > 0.0 && (gauge < kLeastSupply || gauge > kMostSupply))
      found.warning(
          "valve.supply_pressure",
          fmt::format("a supply of {} is unlikely", format_quantity(gauge, Dimension::pressure_gauge)),
          "that of a line of compressed air, some bar", "supply_pressure = \"6 bar gauge\"");
    check_placing(c, found);
    const double height = grid_box(c) ? jet_height(c) : 0.0;
    if (c.flow.solver == FlowSolver::incompressible && c.jet.kind == JetKind::self_similar &&
        height - c.jet.virtual_origin * v.orifice_diameter < 10.0 * v.orifice_diameter)
      found.error("jet.kind", "a self-similar jet needs the box to begin well above the nozzle",
                  "at least 10 orifice diameters between jet.nozzle and z_min, or kind = \"velocity-inlet\"",
                  "[grid.z] points = [\"40 mm\", \"120 mm\"]");
    if (c.jet.kind == JetKind::velocity_inlet && std::abs(height) > v.orifice_diameter)
      found.error(
          "jet.kind", "a velocity inlet stands in the nozzle's exit, but the box does not begin there",
          "[grid.z] points from jet.nozzle on, or kind = \"self-similar\"", "kind = \"self-similar\"");
    if (c.jet.kind == JetKind::computed && c.jet.source_case.empty())
      found.error("jet.source_case", "a computed jet needs the case that computes it",
                  "a case file beside this one", "source_case = \"jet.toml\"");
    if (c.flow.solver == FlowSolver::compressible) check_orifice(c, found);
  }
  if (c.launch.enabled && c.launch.belt_speed <= 0.0)
    found.error("launch.belt_speed", "a belt at rest launches nothing", "a velocity, more than 0",
                "belt_speed = \"3 m/s\"");
  if (c.splitter.edge && (*c.splitter.edge)[0] <= 0.0)
    found.error("splitter.edge", "the edge of the plate is not behind the jet: bodies fly towards +x",
                "x, from jet.nozzle, more than 0; then z", "edge = [\"250 mm\", \"60 mm\"]");
  if (c.splitter.enabled && c.splitter.solid && !(c.splitter.thickness > 0.0))
    found.error("splitter.thickness", "bodies cannot hit a plate without thickness",
                "a length, more than 0, or solid = false", "thickness = \"2 mm\"");
  if (c.splitter.enabled && c.bodies.empty() && !c.sorter.enabled)
    found.warning("splitter", "a dividing plate without a body to divide");
  if (c.launch.enabled && !c.sorter.enabled &&
      std::none_of(c.bodies.begin(), c.bodies.end(), [](const BodySpec& b) { return b.on_belt; }))
    found.warning("launch", "no body comes from the belt", "on_belt = true in a [[body]]");
}

}  // namespace ejecta
