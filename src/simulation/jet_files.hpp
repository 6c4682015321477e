#pragma once
#include <string>

#include "jet/analysis.hpp"
#include "simulation/histories.hpp"

/// Profiles of a jet as histories.
namespace ejecta {

void write_centreline(Histories& histories, double time, const std::string& name, const Centreline& line);

/// A line of the case at one moment.
struct LineProfile {
  std::vector<double> distance;  ///< m from its first end
  std::vector<JetSample> samples;
};
LineProfile line_profile(const JetModel& jet, const LineSpec& spec);
void write_line(Histories& histories, double time, const LineSpec& spec, const LineProfile& profile);

}  // namespace ejecta
