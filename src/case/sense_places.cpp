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

/// Where instruments are, relative to the grid; bodies have a shape, which simulation/body_checks.cpp looks
/// at.
namespace ejecta {
namespace {

/// What the solver of the case can write.
std::vector<std::string> field_names(const Case& c) {
  const FlowSpec& flow = c.flow;
  std::vector<std::string> names{"velocity", "pressure"};
  if (flow.solver != FlowSolver::incompressible) names.push_back("density");
  if (flow.turbulence != TurbulenceModel::laminar)
    names.insert(names.end(), {"k", flow.turbulence == TurbulenceModel::k_epsilon ? "epsilon" : "omega",
                               "eddy_viscosity"});
  if (!c.grains.empty()) names.insert(names.end(), {"void_fraction", "drag_coefficient"});
  return names;
}

void check_fields(const Case& c, Findings& found) {
  const std::vector<std::string> known = field_names(c);
  for (const std::string& name : c.output.fields)
    if (std::find(known.begin(), known.end(), name) == known.end())
      found.error("output.fields", fmt::format("this flow has no field \"{}\"", name),
                  "some of " + joined(known), "fields = [\"velocity\", \"pressure\"]");
}

}  // namespace

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
    require_file(c, fmt::format("measured.{}.file", n), m.file, "missing: the file", "file = \"pitot.csv\"",
                 found);
  }
  const std::optional<Box> box = grid_box(c);
  if (c.flow.solver == FlowSolver::none) {
    for (const auto& [count, section] :
         {std::pair{c.probes.size(), "probe.0"}, {c.lines.size(), "line.0"}, {c.slices.size(), "slice.0"}})
      if (count > 0)
        found.error(section, "without a flow there is nothing to record", "a flow solver",
                    "[flow] solver = \"incompressible\"");
    return;
  }
  check_fields(c, found);
  if (!box) return;
  const auto inside = [&](const std::string& key, const Vec3& p, const char* what) {
    if (!box->contains(p))
      found.error(key, fmt::format("{} lies outside the computed box", what), "a point inside [grid]",
                  place_line(key.substr(key.rfind('.') + 1), p.cwiseMax(box->low).cwiseMin(box->high)));
  };
  for (std::size_t n = 0; n < c.probes.size(); ++n)
    inside(fmt::format("probe.{}.position", n), c.probes[n].position, "the probe");
  for (std::size_t n = 0; n < c.lines.size(); ++n) {
    inside(fmt::format("line.{}.from", n), c.lines[n].from, "this end of the line");
    inside(fmt::format("line.{}.to", n), c.lines[n].to, "this end of the line");
    if (c.lines[n].from == c.lines[n].to)
      found.error(fmt::format("line.{}.to", n), "a line without length", "two different ends",
                  place_line("to", box->high));
  }
  for (std::size_t n = 0; n < c.slices.size(); ++n) {
    const SliceSpec& s = c.slices[n];
    if (s.position < box->low[s.axis] || s.position > box->high[s.axis])
      found.error(fmt::format("slice.{}.position", n), "the slice does not cut the computed box",
                  "a position inside [grid]",
                  fmt::format("position = \"{}\"",
                              format_quantity(0.5 * (box->low + box->high)[s.axis], Dimension::length)));
  }
}

}  // namespace ejecta
