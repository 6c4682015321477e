#pragma once
#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "case/case.hpp"
#include "case/problem.hpp"

namespace ejecta {

/// Collects what the checks of sense.cpp find.
struct Findings {
  std::vector<Problem> list;

  std::ptrdiff_t errors() const {
    return std::count_if(list.begin(), list.end(),
                         [](const Problem& p) { return p.severity == Severity::error; });
  }
  void error(const std::string& key, const std::string& what, const std::string& expected = "",
             const std::string& example = "") {
    list.push_back({.key = key, .what = what, .expected = expected, .example = example});
  }
  void warning(const std::string& key, const std::string& what, const std::string& expected = "",
               const std::string& example = "") {
    list.push_back(
        {.key = key, .what = what, .expected = expected, .example = example, .severity = Severity::warning});
  }
};

// Each looks at one part of the case.
void sense_run(const Case&, Findings&);
void sense_grid(const Case&, Findings&);
void sense_boundaries(const Case&, Findings&);
void sense_states(const Case&, Findings&);
void sense_materials(const Case&, Findings&);
void sense_shapes(const Case&, Findings&);
void sense_motion(const Case&, Findings&);
void sense_grains(const Case&, Findings&);
void sense_domain(const Case&, Findings&);
void sense_overlaps(const Case&, Findings&);
void sense_walls(const Case&, Findings&);
void sense_sorter(const Case&, Findings&);
void sense_records(const Case&, Findings&);
void sense_idle(const Case&, Findings&);
void sense_expectations(const Case&, Findings&);
void sense_map(const Case&, Findings&);
void sense_campaign(const Case&, Findings&);
void sense_machine(const Case&, Findings&);

}  // namespace ejecta
