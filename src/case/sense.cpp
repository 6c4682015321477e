#include "case/sense.hpp"

#include <algorithm>

#include "case/findings.hpp"

namespace ejecta {

std::vector<Problem> check_sense(const Case& c) {
  Findings found;
  for (auto* part : {sense_run, sense_grid, sense_boundaries, sense_materials, sense_shapes, sense_walls,
                     sense_sorter, sense_expectations})
    part(c, found);
  // Places make sense only on a sound grid and with sound shapes.
  const bool sound = std::none_of(found.list.begin(), found.list.end(),
                                  [](const Problem& p) { return p.severity == Severity::error; });
  if (sound)
    for (auto* part : {sense_places, sense_overlaps, sense_records}) part(c, found);
  return found.list;
}

}  // namespace ejecta
