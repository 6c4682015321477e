#include <memory>

#include "app/cli/case_options.hpp"
#include "app/cli/commands.hpp"
#include "app/sort_runs.hpp"

/// The command that computes a whole sorter.
namespace ejecta {

void add_sort(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("sort", "Computes a whole sorter, from the feed to its two products ([sorter])");
  struct SortCommand {
    CaseOptions input;
    SortOptions sort;
  };
  auto o = std::make_shared<SortCommand>();
  add_case_options(*command, o->input);
  command->add_option("--out", o->sort.out, "Directory (default: the name of the case with .sort)")
      ->type_name("DIR");
  add_threads(*command, o->sort.threads);
  command
      ->add_option("--resolved", o->sort.resolved,
                   "Compute N shots, drawn at random, as runs, and correct the result with them")
      ->type_name("N")
      ->check(CLI::Range(2, 100000).description(""));
  command->add_flag("--force", o->sort.force, "Start anew in that directory");
  command->add_flag("-q,--quiet", o->sort.quiet, "Print nothing but errors");
  command->footer(
      "A sorter that was stopped, or killed, goes on when the same command is given again.\n\n"
      "Examples:\n  ejecta sort cases/sorter/tutorial.toml\n"
      "  ejecta sort cases/sorter/tutorial.toml --resolved 60\n"
      "  ejecta sort cases/sorter/combi-sense.toml --set sorter.throughput=\"20 t/h\" --out more.sort");
  command->callback(
      [o, &action] { action = [o] { return sort_case(load_and_warn(o->input, o->sort.quiet), o->sort); }; });
}

}  // namespace ejecta
