#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <functional>
#include <iostream>
#include <optional>

#include "app/signals.hpp"
#include "app/simulation.hpp"
#include "app/teller.hpp"
#include "base/error.hpp"
#include "base/exit_code.hpp"
#include "base/shell_word.hpp"
#include "output/progress.hpp"
#include "output/run_directory.hpp"
#include "output/verdict.hpp"
#include "simulation/jet_sweep.hpp"
#include "simulation/plan.hpp"
#include "workflow/watched_run.hpp"

namespace ejecta {
namespace {

void print_verdict(const Result& result, const std::filesystem::path& run) {
  fmt::print("{}\n", output::verdict_sentence(result.quantities));
  fmt::print("results: {}\n", (run / "result.json").string());
  if (std::filesystem::exists(run / "report.html"))
    fmt::print("report:  {}\n", (run / "report.html").string());
}

output::ProgressOptions progress_options(const RunOptions& o) {
  return output::progress_options_of_terminal(o.quiet     ? output::Verbosity::quiet
                                              : o.verbose ? output::Verbosity::verbose
                                                          : output::Verbosity::normal);
}

/// "ejecta COMMAND CASE --set ...", as a shell takes it: what gives this run again.
std::string command_line_of(const std::string& command, const Case& c, const RunOptions& options) {
  std::string line = "ejecta " + command + " " + shell_word(c.path);
  for (const std::string& set : options.overrides) line += " --set " + shell_word(set);
  if (!options.out.empty()) line += " --out " + shell_word(options.out);
  return line;
}

int exit_code_of(RunEnd end) {
  switch (end) {
    case RunEnd::decided:
      return exit_done;
    case RunEnd::undecided:
      return exit_undecided;
    case RunEnd::stopped:
      break;
  }
  return exit_stopped;
}

/// The run with its progress on the terminal, until its end or a signal.
Result until_a_signal(WatchedRun& watched, const RunOptions& options, const RunFiles& files,
                      const RunOfCase& runner) {
  std::optional<SignalWatch> signals;  // until the first step a signal ends the program at once
  return watched.compute(runner, {.files = files,
                                  .threads = options.threads,
                                  .observe =
                                      [&](const Moment&) {
                                        if (!signals) signals.emplace();
                                      },
                                  .stop = [&] { return signals && signals->stop_requested(); },
                                  .keep = [&] { return signals && signals->take_checkpoint_request(); },
                                  .note = options.quiet ? Note{} : Note(print_note)});
}

/// `command`: that the user gave, "run" or "jet".
int run_into_directory(const std::string& command, const Case& c, RunOptions options,
                       const RunOfCase& runner) {
  const auto directory = output::directory_for(options.out, c.path, "run");
  if (options.resume)
    if (const auto result = finished_run(c, directory)) {
      if (!options.quiet) {
        fmt::print("{} is finished: nothing to compute\n", directory.string());
        print_verdict(*result, directory);
      }
      return exit_code_of(result->end);
    }
  const std::string typed = command_line_of(command, c, options);
  options.out = directory.string();
  const auto here = [&] { return command_line_of(command, c, options); };
  WatchedRun progress(c, std::cerr, progress_options(options));
  const RunFiles files{directory, options.force, options.resume, typed, here(), options.overrides};
  const Result result = until_a_signal(progress, options, files, runner);
  if (result.end == RunEnd::stopped) {
    progress.note(fmt::format("continue with\n  {} --resume", here()));
    return exit_stopped;
  }
  if (!options.quiet) {
    if (options.verbose || c.flow.solver != FlowSolver::none)
      fmt::print("{}\n", output::operator_table(result.operators, result.wall_time));
    print_verdict(result, directory);
  }
  if (result.later_end) {
    options.overrides.push_back(fmt::format("run.end_time={:.0f} ms", 1e3 * *result.later_end));
    progress.note(fmt::format("go on with\n  {} --resume", here()));
  }
  return exit_code_of(result.end);
}

int sweep(const Case& c, const RunOptions& options) {
  const std::string typed = command_line_of("jet --sweep", c, options);
  const auto directory = output::directory_for(options.out, c.path, "run");
  const SignalWatch signals;
  const auto result =
      sweep_jet(c, {.files = RunFiles{directory, options.force, false, typed, typed, options.overrides},
                    .threads = options.threads,
                    .stop = [&] { return signals.stop_requested(); },
                    .note = options.quiet ? Note{} : Note(print_note)});
  if (!result) {
    print_note("stopped: a sweep keeps nothing before its end");
    return exit_stopped;
  }
  if (!options.quiet) fmt::print("{}\n", result->dump(2));
  return exit_done;
}

}  // namespace

int plan_case(const Case& c, bool quiet) {
  const std::vector<OperatorTime> step = planned_step(c);
  if (!quiet) fmt::print("{}\n", plan_text(c, step));
  return exit_done;
}

int run_case(const Case& c, const RunOptions& options) {
  if (options.dry_run) return plan_case(c, options.quiet);
  return run_into_directory("run", c, options, run);
}

int jet_case(const Case& c, const RunOptions& options) {
  const auto [jet, kept_at] = jet_of(c);
  if (options.sweep) return sweep(jet, options);
  return run_into_directory("jet", jet, options, [kept_at = kept_at](const Case& of, const Context& context) {
    return run_jet(of, kept_at, context);
  });
}

}  // namespace ejecta
