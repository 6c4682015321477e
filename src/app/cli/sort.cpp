#include <fmt/format.h>

#include <memory>

#include "app/cli/case_options.hpp"
#include "app/cli/commands.hpp"
#include "app/signals.hpp"
#include "app/teller.hpp"
#include "base/exit_code.hpp"
#include "workflow/sort.hpp"

/// The command that computes a whole sorter.
namespace ejecta {
namespace {

struct SortCommand {
  CaseOptions input;
  SortOptions sort{.program = this_program()};
  bool quiet = false;
};

int sort_case(const Case& c, const SortCommand& o) {
  Teller teller(o.quiet);
  const SortEnd end = compute_sorter(
      c, o.sort,
      {.note = o.quiet ? Note{} : Note(print_note),
       .share =
           [&](double done, bool last) {
             teller.tell([&] { return fmt::format("{:.0f} % of the belt", 100 * done); }, last);
           },
       .stop = stop_on_signal()});
  if (end.stopped) {
    print_note("stopped; go on with the same command");
    return exit_stopped;
  }
  const auto file = [&](const char* name) { return (end.directory / name).string(); };
  const int failed = end.result.value("resolved_shots_failed", 0);
  if (failed > 0)
    print_note(fmt::format(
        "error: {} of {} shots could not be computed as runs, which leaves the others a biased sample: {}\n"
        "  all of them:  ejecta study status {}",
        failed, o.sort.resolved, end.result.value("first_failure", ""), file("resolved")));
  if (!o.quiet) {
    print_result(fmt::format("{}\nresults: {}\ntable:   {}", end.result.at("summary").get<std::string>(),
                             file("result.json"), file("fates.csv")));
    if (c.output.report) print_result("report:  " + file("report.html"));
  }
  return failed > 0 ? exit_failure : exit_done;
}

}  // namespace

void add_sort(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("sort", "Computes a whole sorter, from the feed to its two products ([sorter])");
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
  command->add_flag("-q,--quiet", o->quiet, "Print nothing but errors");
  command->footer(
      "A sorter that was stopped, or killed, goes on when the same command is given again.\n\n"
      "Examples:\n  ejecta sort cases/sorter/tutorial.toml\n"
      "  ejecta sort cases/sorter/tutorial.toml --resolved 60\n"
      "  ejecta sort cases/sorter/combi-sense.toml --set sorter.throughput=\"20 t/h\" --out more.sort");
  command->callback(
      [o, &action] { action = [o] { return sort_case(load_and_warn(o->input, o->quiet), *o); }; });
}

}  // namespace ejecta
