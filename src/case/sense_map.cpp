#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <tuple>

#include "base/units.hpp"
#include "case/extent.hpp"
#include "case/findings.hpp"
#include "case/load.hpp"
#include "case/map_grid.hpp"
#include "case/outline_file.hpp"
#include "case/required_file.hpp"
#include "case/symmetry.hpp"

/// [map]: whether there is something to map, and a window in which it can be.
namespace ejecta {
namespace {

std::string mm(double metres) { return format_quantity(metres, Dimension::length); }

bool has_plate_and_launch(const Case& c, Findings& found) {
  if (!c.launch.enabled)
    found.error("map", "a map needs the flight of the body to the jet, but there is no [launch]", "[launch]",
                "[launch] belt_speed = \"3 m/s\"");
  if (!c.splitter.enabled)
    found.error("map", "a map needs a plate that decides, but there is no [splitter]", "[splitter]",
                "[splitter] distance = \"250 mm\", height = \"18 mm\"");
  return c.launch.enabled && c.splitter.enabled;
}

bool has_body(const Case& c, Findings& found) {
  const std::size_t body = mapped_body(c);
  if (body == c.bodies.size()) {
    found.error(c.map.body.empty() ? "map" : "map.body",
                c.map.body.empty() ? "no body comes from the belt"
                                   : fmt::format("there is no body \"{}\"", c.map.body),
                "the name of a [[body]] with on_belt = true", "body = \"particle\"");
    return false;
  }
  if (!c.bodies[body].on_belt || !c.bodies[body].behind.empty()) {
    found.error("map.body", fmt::format("\"{}\" is not placed on the belt by itself", c.bodies[body].name),
                "a body with on_belt = true, and without `behind`", "on_belt = true");
    return false;
  }
  return true;
}

void check_window(const Case& c, Findings& found) {
  const MapSpec& m = c.map;
  const auto range = [&](const char* key, const std::array<double, 2>& r) {
    if (r[0] < r[1]) return true;
    found.error(std::string("map.") + key,
                fmt::format("the window from {} to {} has no width", mm(r[0]), mm(r[1])),
                "its lower end, then its upper end", std::string(key) + " = [\"-18 mm\", \"18 mm\"]");
    return false;
  };
  if (!range("along", m.along) || !range("across", m.across)) return;
  const double plate = c.splitter.edge ? (*c.splitter.edge)[0] : c.splitter.distance;
  if (m.plate_error[0] >= plate)
    return found.error("map.plate_error",
                       fmt::format("the plate may be off by more than it is away, {}", mm(plate)),
                       "how well the place of the plate is known", "plate_error = [\"5 mm\", \"2 mm\"]");
  if (m.along[1] >= plate - m.plate_error[0])
    found.error("map.along", fmt::format("the window reaches to the plate, {} behind the jet", mm(plate)),
                "places between the belt and the plate",
                fmt::format("along = [\"{}\", \"{}\"]", mm(-0.5 * plate), mm(0.5 * plate)));
  const Vec3 size = half_extent(c.bodies[mapped_body(c)]);
  for (const auto& [key, range, error] : {std::tuple{"along", m.along, m.arrival_error[0]},
                                          std::tuple{"across", m.across, m.arrival_error[1]}}) {
    const double width = range[1] - range[0];
    if (width < 0.2 * size.maxCoeff())
      found.error(std::string("map.") + key,
                  fmt::format("the window is {} wide, a small part of the body", mm(width)),
                  "a window in which the body is ejected at some places and not at others",
                  std::string(key) + " = [\"-18 mm\", \"18 mm\"]");
    if (error > width)
      found.error("map.arrival_error",
                  fmt::format("bodies come {} beside where they are expected, the window is {} wide",
                              mm(error), mm(width)),
                  "less than the window", "arrival_error = [\"1 mm\", \"1 mm\"]");
  }
  const auto box = grid_box(c);
  if (!box || c.flow.solver == FlowSolver::none) return;
  const Vec3 half = std::max(m.size_factor[0], m.size_factor[1]) * size;
  const double y = c.jet.nozzle.y(), right = box->high.y() - y, left = y - box->low.y();
  if (half.y() >= std::min(left, right))
    return found.error(
        "map.size_factor",
        fmt::format("the largest body of the class, {} across, does not fit the box", mm(2.0 * half.y())),
        "sizes that fit, or a wider box", "size_factor = [0.8, 1.2]");
  if (m.across[1] + half.y() > right || m.across[0] - half.y() < -left)
    found.error("map.across",
                fmt::format("at its ends the body leaves the box, which is from {} to {} beside the jet",
                            mm(-left), mm(right)),
                "a window within the box, or a wider box",
                fmt::format("across = [\"{}\", \"{}\"]", mm(half.y() - left), mm(right - half.y())));
  if (c.valve.shape == ValveShape::trace) return;
  // Where the centre may be while the jet blows, over the whole window.
  const double v = c.launch.belt_speed, begins = c.valve.opens_at + c.valve.delay,
               ends = begins + c.valve.duration + c.valve.fall_time;
  const double first = m.along[0] + v * (begins - c.launch.arrives_at),
               last = m.along[1] + v * (ends - c.launch.arrives_at), x = c.jet.nozzle.x();
  if (c.valve.more_pulses.empty() && (first > box->high.x() - x || last < box->low.x() - x))
    found.error("map.along",
                fmt::format("no body of this window is in the box while the jet blows, from {} to {}",
                            format_quantity(begins, Dimension::time), format_quantity(ends, Dimension::time)),
                "places at launch.arrives_at from which it meets the jet", "along = [\"-30 mm\", \"20 mm\"]");
}

void check_grid(const Case& c, Findings& found) {
  const MapSpec& m = c.map;
  const auto [along, across] = m.grid;
  if (along == 0.0 && across == 0.0) return;
  const std::string example = "grid = [\"3 mm\", \"2.5 mm\"]";
  if (!m.is_on_grid())
    return found.error("map.grid", "a grid with one step", "its steps along and across", example);
  if (m.is_of_chance())
    return found.error("map.grid", "a grid has one run at each place, which tells no chance of ejection",
                       "no `grid`, or a single body: no `lying`, `size_factor`, `arrival_error`",
                       "grid = [\"0 mm\", \"0 mm\"]");
  if (!(m.along[0] < m.along[1]) || !(m.across[0] < m.across[1])) return;  // told already
  const bool half = map_is_symmetric(c);
  const double highest = half ? std::max(m.across[1], -m.across[0]) : m.across[1];
  const MapGrid grid = map_grid(m.along, {half ? 0.0 : m.across[0], highest}, m.grid);
  if (!grid.is_plane(half))
    return found.error("map.grid",
                       fmt::format("steps of {} and {} leave fewer than three rows or columns in the window",
                                   mm(along), mm(across)),
                       "shorter steps, or a larger window",
                       fmt::format("grid = [\"{:.3g} mm\", \"{:.3g} mm\"]", 100.0 * (m.along[1] - m.along[0]),
                                   100.0 * (highest - (half ? 0.0 : m.across[0]))));
  if (grid.places() > m.max_runs)
    found.error(
        "map.grid",
        fmt::format("its {:.0f} places in the window are more than max_runs = {}", grid.places(), m.max_runs),
        "longer steps, a smaller window, or more runs",
        grid.places() <= 10000.0 ? fmt::format("max_runs = {:.0f}", grid.places()) : example);
}

}  // namespace

void sense_map(const Case& c, Findings& found) {
  if (!c.map.enabled) return;
  if (c.flow.solver == FlowSolver::none)
    found.warning("map", "a map of the places where the air throws a body, and no air: nothing is ejected",
                  "a flow with a jet", "[flow] solver = \"incompressible\"");
  if (!has_plate_and_launch(c, found) || !has_body(c, found)) return;
  check_window(c, found);
  check_grid(c, found);
  if (!c.map.measured.empty() && require_file(c, "map.measured", c.map.measured, "missing: the file",
                                              "measured = \"outline.csv\"", found))
    read_outline_file(beside_case(c, c.map.measured), found.list);
  const std::size_t body = mapped_body(c);
  if (c.map.symmetric.value_or(false))
    if (const Symmetry s = symmetry_across(c, body); !s.refused.empty())
      found.error("map.symmetric", fmt::format("the map is not even in y: {}", s.refused),
                  "false, or nothing", "symmetric = false");
  if (c.map.size_factor[0] > c.map.size_factor[1])
    found.error("map.size_factor", "the sizes end below where they begin",
                "the smallest, then the largest factor", "size_factor = [0.8, 1.2]");
  if (c.map.lying != MapLying::given && c.bodies[body].shape == ShapeKind::sphere)
    found.error("map.lying", "a sphere lies the same, however it is turned", "nothing, or another shape",
                "lying = \"given\"");
  if (c.map.max_fine_runs > c.map.max_runs && c.given.contains("map.max_fine_runs"))
    found.error("map.max_fine_runs", "more fine runs than runs", "at most map.max_runs",
                fmt::format("max_fine_runs = {}", c.map.max_runs));
  if (c.bodies[body].copies > 1)
    found.error("map.body", "copies of the body are on the belt too", "a body without copies", "copies = 1");
}

}  // namespace ejecta
