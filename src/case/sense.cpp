#include "case/sense.hpp"

#include <algorithm>
#include <array>

#include "case/findings.hpp"

namespace ejecta {
namespace {

struct Part {
  void (*look)(const Case&, Findings&);
  std::vector<std::string> sections;  ///< what it reads
};

const std::array<Part, 17> parts{{
    {sense_run, {"run", "environment", "fluid", "flow", "body", "splitter"}},
    {sense_grid, {"grid"}},
    {sense_boundaries, {"run", "boundary", "environment", "flow", "grid"}},
    {sense_states, {"run", "boundary", "initial", "flow", "grid", "environment", "fluid", "body"}},
    {sense_materials, {"material", "material_pair", "contact"}},
    {sense_shapes, {"body", "material", "launch", "run", "domain"}},
    {sense_motion, {"body", "run"}},
    {sense_grains, {"grains", "coupling", "material", "grid", "flow"}},
    {sense_domain, {"domain", "flow"}},
    {sense_walls, {"wall", "material", "splitter"}},
    {sense_sorter,
     {"run", "environment", "flow", "grid", "boundary", "valve", "jet", "launch", "splitter", "body"}},
    {sense_expectations, {"expect", "convergence", "exact", "flow", "probe", "body", "stream", "splitter"}},
    {sense_overlaps, {"body", "launch"}},
    {sense_records, {"grid", "flow", "probe", "line", "slice"}},
    {sense_map,
     {"map", "launch", "splitter", "body", "grid", "boundary", "jet", "valve", "environment", "flow"}},
    {sense_machine, {"sorter", "launch", "splitter", "valve", "jet", "boundary", "grid", "fluid"}},
    {sense_idle,
     {"boundary", "valve", "contact", "body", "wall", "splitter", "grains", "coupling", "sorter", "stream",
      "flow", "study"}},
}};

}  // namespace

std::vector<Problem> check_sense(const Case& c, std::set<std::string> unsound) {
  Findings found;
  if (c.campaign.enabled) {
    sense_campaign(c, found);
    return found.list;
  }
  for (const Part& part : parts) {
    if (std::any_of(part.sections.begin(), part.sections.end(),
                    [&](const std::string& s) { return unsound.contains(s); }))
      continue;
    const std::size_t before = found.list.size();
    part.look(c, found);
    for (std::size_t n = before; n < found.list.size(); ++n)
      if (found.list[n].severity == Severity::error) unsound.insert(section_of(found.list[n].key));
  }
  return found.list;
}

std::string section_of(const std::string& key) { return key.substr(0, key.find('.')); }

}  // namespace ejecta
