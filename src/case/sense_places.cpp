#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/text.hpp"
#include "base/units.hpp"
#include "case/extent.hpp"
#include "case/findings.hpp"
#include "case/load.hpp"
#include "case/names.hpp"
#include "case/schema.hpp"

/// Where bodies and instruments are, relative to the grid.
namespace ejecta {
namespace {

constexpr double cells_needed = 4.0, cells_advised = 8.0;  // across the smallest feature (Hager 2014: 8)

void check_place(const Case& c, const Box& box, std::size_t n, Findings& found) {
  const BodySpec& b = c.bodies[n];
  const std::string key = fmt::format("body.{}", n),
                    place_key = b.on_belt ? "launch.stand_off" : key + ".position";
  const Vec3 half = half_extent(b), at = place_of_interest(c, b);
  for (int a = 0; a < 3; ++a) {
    const bool thick = c.grid.axis[static_cast<std::size_t>(a)].cells != std::vector<int>{1};
    if (thick && 2.0 * half.minCoeff() > box.high[a] - box.low[a])
      return found.error(
          key,
          fmt::format("the body is larger than the box along {}", axis_names[static_cast<std::size_t>(a)]),
          "a larger [grid] or a smaller body");
  }
  if (!box.contains(at)) {
    const std::string what = b.on_belt ? "the body crosses the jet's axis outside the computed box"
                                       : "the body starts outside the computed box";
    const std::string expected = fmt::format(
        "x in {} to {}, y in {} to {}, z in {} to {}", format_quantity(box.low[0], Dimension::length),
        format_quantity(box.high[0], Dimension::length), format_quantity(box.low[1], Dimension::length),
        format_quantity(box.high[1], Dimension::length), format_quantity(box.low[2], Dimension::length),
        format_quantity(box.high[2], Dimension::length));
    if (b.on_belt || b.motion == Motion::fixed)
      found.error(place_key, what + ": no air would ever reach it", expected);
    else found.warning(place_key, what + ": no air reaches it before it enters", expected);
    return;
  }
  if (b.on_belt && (at[2] - half[2] < box.low[2] || at[2] + half[2] > box.high[2]))
    found.error(place_key,
                "the domain is too small for the path: the body sticks out of the box where it crosses the "
                "jet's axis",
                "a taller [grid.z] or another stand_off");

  const double across = cells_across(c, b);
  if (smallest_feature(b) <= 0.0) return;
  const std::string what = fmt::format("{:.2g} cells across the smallest feature ({})", across,
                                       format_quantity(smallest_feature(b), Dimension::length));
  if (across < cells_needed)
    found.error(key, what + ": the air's force on it would be wrong",
                fmt::format("at least {}, better {}", cells_needed, cells_advised));
  else if (across < cells_advised)
    found.warning(key, what,
                  fmt::format("at least {} for results that do not depend on the grid", cells_advised));
}

/// What the solver of the case can write.
std::vector<std::string> field_names(const FlowSpec& flow) {
  std::vector<std::string> names{"velocity", "pressure"};
  if (flow.solver != FlowSolver::incompressible) names.push_back("density");
  if (flow.turbulence != TurbulenceModel::laminar)
    names.insert(names.end(), {"k", flow.turbulence == TurbulenceModel::k_epsilon ? "epsilon" : "omega",
                               "eddy_viscosity"});
  return names;
}

void check_fields(const Case& c, Findings& found) {
  const std::vector<std::string> known = field_names(c.flow);
  for (const std::string& name : c.output.fields)
    if (std::find(known.begin(), known.end(), name) == known.end())
      found.error("output.fields", fmt::format("this flow has no field \"{}\"", name),
                  "some of " + joined(known), "fields = [\"velocity\", \"pressure\"]");
}

}  // namespace

void sense_places(const Case& c, Findings& found) {
  const std::optional<Box> box = grid_box(c);
  if (c.flow.solver == FlowSolver::none || !box) return;
  for (std::size_t n = 0; n < c.bodies.size(); ++n) check_place(c, *box, n, found);
}

void sense_records(const Case& c, Findings& found) {
  check_file_names(c.probes, "probe", found);
  check_file_names(c.lines, "line", found);
  check_file_names(c.slices, "slice", found);
  for (std::size_t n = 0; n < c.measured.size(); ++n) {
    const MeasuredSpec& m = c.measured[n];
    const auto named = [&](const auto& list) {
      return std::any_of(list.begin(), list.end(), [&](const auto& s) { return s.name == m.of; });
    };
    if (m.of != "centreline" && !named(c.lines) && !named(c.probes))
      found.error(fmt::format("measured.{}.of", n),
                  fmt::format("nothing is recorded under the name \"{}\"", m.of),
                  "\"centreline\", or the name of a [[line]] or [[probe]]", "of = \"centreline\"");
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(beside_case(c, m.file), ignored))
      found.error(fmt::format("measured.{}.file", n),
                  fmt::format("there is no file \"{}\"", beside_case(c, m.file)),
                  "a file, relative to the folder of the case", "file = \"pitot.csv\"");
  }
  const std::optional<Box> box = grid_box(c);
  if (c.flow.solver == FlowSolver::none) {
    for (const auto& [count, section] :
         {std::pair{c.probes.size(), "probe.0"}, {c.lines.size(), "line.0"}, {c.slices.size(), "slice.0"}})
      if (count > 0) found.error(section, "without a flow there is nothing to record", "a flow solver");
    return;
  }
  check_fields(c, found);
  if (!box) return;
  const auto inside = [&](const std::string& key, const Vec3& p, const char* what) {
    if (!box->contains(p))
      found.error(key, fmt::format("{} lies outside the computed box", what), "a point inside [grid]");
  };
  for (std::size_t n = 0; n < c.probes.size(); ++n)
    inside(fmt::format("probe.{}.position", n), c.probes[n].position, "the probe");
  for (std::size_t n = 0; n < c.lines.size(); ++n) {
    inside(fmt::format("line.{}.from", n), c.lines[n].from, "this end of the line");
    inside(fmt::format("line.{}.to", n), c.lines[n].to, "this end of the line");
    if (c.lines[n].from == c.lines[n].to)
      found.error(fmt::format("line.{}.to", n), "a line without length", "two different ends");
  }
  for (std::size_t n = 0; n < c.slices.size(); ++n) {
    const SliceSpec& s = c.slices[n];
    if (s.position < box->low[s.axis] || s.position > box->high[s.axis])
      found.error(fmt::format("slice.{}.position", n), "the slice does not cut the computed box",
                  "a position inside [grid]");
  }
}

}  // namespace ejecta
