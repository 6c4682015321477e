#pragma once
#include <span>
#include <string>

#include "jet/analysis.hpp"
#include "output/run_directory.hpp"

/// Profiles of a jet as files of history/.
namespace ejecta {

void write_centreline(const output::RunDirectory& directory, std::span<const std::string> provenance,
                      double time, const std::string& name, const Centreline& line);

/// A line of the case at one moment.
struct LineProfile {
  std::vector<double> distance;  ///< m from its first end
  std::vector<JetSample> samples;
};
LineProfile line_profile(const JetModel& jet, const LineSpec& spec);
void write_line(const output::RunDirectory& directory, std::span<const std::string> provenance, double time,
                const LineSpec& spec, const LineProfile& profile);

}  // namespace ejecta
