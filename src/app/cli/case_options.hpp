#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "case/case.hpp"

namespace ejecta {

/// A case file and what the command line changes in it.
struct CaseOptions {
  std::string path;
  std::vector<std::string> overrides;
};

/// Adds CASE and --set to a command.
void add_case_options(CLI::App& command, CaseOptions& options);

void add_overrides(CLI::App& command, std::vector<std::string>& overrides);
void add_threads(CLI::App& command, int& threads);

/// Loads the case and, unless `quiet`, prints what is unlikely to be meant to stderr.
Case load_and_warn(const CaseOptions& options, bool quiet = false);

}  // namespace ejecta
