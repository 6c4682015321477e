#pragma once
#include <string>
#include <vector>

#include "case/case.hpp"

namespace ejecta {

struct RunOptions {
  std::string out;  ///< run directory; empty: the name of the case with ".run", where the command was given
  int threads = 0;  ///< 0: as many as the machine has
  bool resume = false;
  bool force = false;    ///< overwrite a run directory
  bool dry_run = false;  ///< set everything up, take no step
  bool quiet = false, verbose = false;
  std::vector<std::string> overrides{};  ///< what --set changed, "section.key=value"
  bool sweep = false;  ///< `ejecta jet`: the jets of jet.sweep_pressures and jet.sweep_velocities instead
};

/// Runs a case into its run directory. Returns an ExitCode.
int run_case(const Case& c, const RunOptions& options);
/// Prints the operators of a step with their equations; computes nothing. Returns an ExitCode.
int plan_case(const Case& c, bool quiet = false);
/// Computes only the jet of a case and stores it. Returns an ExitCode.
int jet_case(const Case& c, const RunOptions& options);
}  // namespace ejecta
