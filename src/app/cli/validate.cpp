#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "app/cli/case_options.hpp"
#include "app/cli/commands.hpp"
#include "app/signals.hpp"
#include "app/teller.hpp"
#include "base/exit_code.hpp"
#include "simulation/body_checks.hpp"
#include "validation/validation.hpp"
#include "workflow/result_of.hpp"

namespace ejecta {
void add_validate(CLI::App& app, Action& action) {
  struct Options {
    std::vector<std::string> names;
    std::string out = "validation.runs";
    int threads = 0;
    bool list = false;
  };
  CLI::App* command =
      app.add_subcommand("validate", "Runs shipped validation cases and compares them with their references");
  auto o = std::make_shared<Options>();
  command
      ->add_option("NAME", o->names,
                   "Part of the name of a shipped case, a case file, or a directory; none: all")
      ->type_name("");
  command->add_option("--out", o->out, "Where the run directories go")
      ->type_name("DIR")
      ->capture_default_str();
  add_threads(*command, o->threads);
  command->add_flag("--list", o->list, "Only name the cases");
  command->footer(
      "Examples:\n  ejecta validate --list\n  ejecta validate taylor-green\n  ejecta validate my-case.toml");
  command->callback([o, &action] {
    action = [o] {
      const auto files = validation_cases(o->names, shipped_cases());
      if (o->list) {
        for (const auto& file : files) fmt::print("{}\n", file.string());
        return int{exit_done};
      }
      const Runner runner{
          .load = [](const std::string& path) { return load_checked(path); },
          .run =
              [&, stop = stop_on_signal()](const Case& c, const std::filesystem::path& directory) {
                return result_of(c, directory, {.threads = o->threads, .stop = stop});
              }};
      const std::vector<Validation> done = validate_cases(files, o->out, runner, print_note);
      fmt::print("{}", validation_table(done));
      return int{exit_code_of(done)};
    };
  });
}

}  // namespace ejecta
