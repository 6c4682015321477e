#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "app/cli/case_options.hpp"
#include "app/cli/commands.hpp"
#include "app/exit_code.hpp"
#include "app/validation.hpp"

namespace ejecta {
namespace {

/// A case whose orifice drives a compressible flow is one of `ejecta jet`.
int run_or_jet(const Case& c, const RunOptions& options) {
  const auto& patches = c.boundary[4].patches;
  const bool jet = c.flow.solver == FlowSolver::compressible &&
                   std::any_of(patches.begin(), patches.end(),
                               [](const PatchSpec& p) { return p.type == BoundaryType::jet; });
  return jet ? jet_case(c, options) : run_case(c, options);
}

}  // namespace

void add_validate(CLI::App& app, Action& action) {
  struct Options {
    std::vector<std::string> names;
    RunOptions run{.out = "validation.runs", .force = true, .quiet = true};
    bool list = false;
  };
  CLI::App* command =
      app.add_subcommand("validate", "Runs shipped validation cases and compares them with their references");
  auto o = std::make_shared<Options>();
  command
      ->add_option("NAME", o->names,
                   "Part of the name of a shipped case, a case file, or a directory; none: all")
      ->type_name("");
  command->add_option("--out", o->run.out, "Where the run directories go")
      ->type_name("DIR")
      ->capture_default_str();
  add_threads(*command, o->run.threads);
  command->add_flag("--list", o->list, "Only name the cases");
  command->footer(
      "Examples:\n  ejecta validate --list\n  ejecta validate taylor-green\n  ejecta validate my-case.toml");
  command->callback([o, &action] {
    action = [o] {
      const auto files = validation_cases(o->names, shipped_cases());
      std::vector<Validation> done;
      for (const auto& file : files) {
        if (o->list) {
          fmt::print("{}\n", file.string());
          continue;
        }
        fmt::print(stderr, "[{}/{}] {}\n", done.size() + 1, files.size(), file.string());
        done.push_back(validate_case(file.string(), o->run, run_or_jet));
      }
      if (o->list) return int{exit_done};
      fmt::print("{}", validation_table(done));
      return std::all_of(done.begin(), done.end(), [](const Validation& v) { return v.pass(); })
                 ? int{exit_done}
                 : int{exit_validation};
    };
  });
}

}  // namespace ejecta
