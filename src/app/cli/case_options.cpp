#include "app/cli/case_options.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "simulation/body_checks.hpp"
#include "validation/validation.hpp"

namespace ejecta {

void add_case_options(CLI::App& command, CaseOptions& options) {
  command.add_option("CASE", options.path, "Case file (.toml), or the name of a shipped case")
      ->required()
      ->type_name("");
  add_overrides(command, options.overrides);
}

void add_overrides(CLI::App& command, std::vector<std::string>& overrides) {
  command.add_option("--set", overrides, "Change a key: section.key=value; may be repeated")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->take_all();
}

void add_threads(CLI::App& command, int& threads) {
  command.add_option("--threads", threads, "Threads (default: all cores)")
      ->type_name("N")
      ->check(CLI::Range(1, 1024).description(""));
}

Case load_and_warn(const CaseOptions& options, bool quiet) {
  std::vector<Problem> warnings;
  Case c = load_checked(case_file(options.path), options.overrides, &warnings);
  if (!quiet)
    for (const Problem& p : warnings) fmt::print(stderr, "{}\n", render(p));
  return c;
}

}  // namespace ejecta
