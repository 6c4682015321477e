#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <optional>

#include "app/cli/case_options.hpp"
#include "app/cli/commands.hpp"
#include "app/cli/input_error.hpp"
#include "app/exit_code.hpp"
#include "simulation/body_checks.hpp"
#include "simulation/forecast.hpp"

namespace ejecta {

void add_check(CLI::App& app, Action& action) {
  struct Options {
    std::vector<std::string> cases, overrides;
  };
  CLI::App* command = app.add_subcommand(
      "check", "What a run will be: cells, steps, time, memory, disk, assumptions; runs nothing");
  auto o = std::make_shared<Options>();
  command->add_option("CASE", o->cases, "Case files (.toml)")->required()->type_name("");
  command->add_option("--set", o->overrides, "Change a key: section.key=value; may be repeated")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->take_all();
  command->footer("Example:\n  ejecta check cases/paper/*.toml");
  command->callback([o, &action] {
    action = [o] {
      const double bandwidth = measured_bandwidth();
      int code = exit_done;
      for (const std::string& path : o->cases) {
        try {
          std::vector<Problem> warnings;
          std::optional<Scene> scene;
          const Case c = load_checked(case_file(path), o->overrides, &warnings, &scene);
          fmt::print("{}\n", check_report(c, *scene, warnings, bandwidth));
        } catch (const InputError& e) {
          print_input_error(e);
          code = exit_bad_input;
        }
      }
      return code;
    };
  });
}

}  // namespace ejecta
