#pragma once
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "case/case.hpp"
#include "case/problem.hpp"
#include "simulation/prospect.hpp"

namespace ejecta {

/// What a run will be, told from the case alone.
struct Forecast {
  std::int64_t cells = 0;
  double smallest_cell = 0.0, largest_cell = 0.0;      ///< m, edges
  double smallest_volume = 0.0, largest_volume = 0.0;  ///< m3
  double fastest = 0.0;                                ///< m/s, the speed that limits the step
  double air_until = 0.0;                              ///< s: bodies fly on without flow
  double time_step = 0.0;                              ///< s, the shortest
  bool by_viscosity = false;  ///< it is the viscosity of a laminar flow that limits the step
  bool knows_step = false;    ///< false: nothing given tells how fast the fluid will be
  std::int64_t steps = 0;
  double memory = 0.0;  ///< bytes
  double disk = 0.0;    ///< bytes
};
Forecast forecast(const Case& c);
/// The same where the bodies are there already: building those of large surfaces takes seconds.
Forecast forecast(const Case& c, const Company& company);

/// Seconds that the steps take at the rate (bytes/s) at which this machine moves data.
double expected_seconds(const Case& c, const Forecast& f, double bandwidth, std::span<const Body> grains);
/// Measured in about a tenth of a second, bytes/s.
double measured_bandwidth();

/// How many such runs this machine can do side by side: cores and free memory.
int runs_side_by_side(const Case& c);

/// All of it as the text of `ejecta check`, with the warnings of the case; `scene`: of the case, see
/// scene_of.
std::string check_report(const Case& c, const Scene& scene, const std::vector<Problem>& warnings,
                         double bandwidth);

/// The same as `ejecta check --json` gives it (docs/files.md).
nlohmann::ordered_json check_json(const Case& c, const Scene& scene, const std::vector<Problem>& warnings,
                                  double bandwidth);
nlohmann::ordered_json problem_json(const Problem& p);
nlohmann::ordered_json problems_json(const std::vector<Problem>& list);

}  // namespace ejecta
