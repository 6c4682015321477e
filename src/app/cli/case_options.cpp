#include "app/cli/case_options.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "case/load.hpp"
#include "case/sense.hpp"

namespace ejecta {

void add_case_options(CLI::App& command, CaseOptions& options) {
  command.add_option("CASE", options.path, "Case file (.toml)")->required();
  command.add_option("--set", options.overrides, "Change a key: section.key=value; may be repeated")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->take_all();
}

Case load_and_warn(const CaseOptions& options) {
  Case c = load_case(options.path, options.overrides);
  for (const Problem& p : check_sense(c))
    if (p.severity == Severity::warning) fmt::print(stderr, "{}\n", render(p));
  return c;
}

}  // namespace ejecta
