#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <functional>
#include <iostream>
#include <optional>

#include "app/signals.hpp"
#include "app/simulation.hpp"
#include "base/error.hpp"
#include "base/exit_code.hpp"
#include "base/parallel.hpp"
#include "jet/inlet.hpp"
#include "jet/store.hpp"
#include "output/progress.hpp"
#include "output/run_directory.hpp"
#include "output/verdict.hpp"
#include "simulation/coupled_model.hpp"
#include "simulation/jet_sweep.hpp"
#include "simulation/run.hpp"

namespace ejecta {
namespace {

using RunOfCase = std::function<Result(const Case&, const Context&)>;

void print_note(const std::string& line) { fmt::print(stderr, "{}\n", line); }

void print_verdict(const Result& result, const std::filesystem::path& run) {
  fmt::print("{}\n", output::verdict_sentence(result.quantities));
  fmt::print("results: {}\n", (run / "result.json").string());
  if (std::filesystem::exists(run / "report.html"))
    fmt::print("report:  {}\n", (run / "report.html").string());
}

void print_step(const Case& c, const Model& model) {
  fmt::print("One step of {}:\n", c.path);
  int n = 0;
  for (const auto& op : model.operator_times()) fmt::print("  {:2}. {:<26} {}\n", ++n, op.name, op.equation);
}

std::string start_line(const Case& c, const Moment& m, const std::filesystem::path& directory) {
  const auto bodies = m.model.bodies();
  return fmt::format("{}: {} cells, {} bod{}, {} thread{} -> {}{}", c.path, m.model.cells(), bodies,
                     bodies == 1 ? "y" : "ies", thread_count(), thread_count() == 1 ? "" : "s",
                     directory.string(), m.step > 0 ? fmt::format(", from t = {:.3f} ms", 1e3 * m.time) : "");
}

/// How far a run is, on the terminal and in its progress.json.
class ProgressOfRun {
 public:
  ProgressOfRun(const Case& c, const RunOptions& options, std::filesystem::path directory)
      : case_(c), options_(options), directory_(std::move(directory)) {}

  void observe(const Moment& m) {
    last_ = {m.time, m.busy_until, m.step, m.dt, m.model.courant(), m.model.cells()};
    if (progress_) return progress_->update(last_);
    auto p = output::progress_options_of_terminal(options_.quiet     ? output::Verbosity::quiet
                                                  : options_.verbose ? output::Verbosity::verbose
                                                                     : output::Verbosity::normal);
    p.file = output::RunDirectory::open(directory_).progress();
    progress_.emplace(std::cerr, p);
    progress_->note(start_line(case_, m, directory_));
    if (thread_count() > core_count())
      progress_->note(fmt::format("{} threads share {} core{}: more threads than cores make a run slower",
                                  thread_count(), core_count(), core_count() == 1 ? "" : "s"));
  }
  void note(const std::string& line) {
    if (progress_) progress_->note(line);
  }
  void finish(const std::string& state) {
    if (progress_) progress_->finish(last_, state);
  }
  /// Leaves the reason in progress.json, if that can still be written.
  void give_up(const std::string& state) {
    try {
      finish(state);
    } catch (const Error&) {
    }
  }

 private:
  const Case& case_;
  const RunOptions& options_;
  std::filesystem::path directory_;
  std::optional<output::Progress> progress_;
  output::ProgressState last_;
};

std::filesystem::path directory_of(const Case& c, const RunOptions& options) {
  return options.out.empty() ? output::RunDirectory::default_path(c.path)
                             : std::filesystem::path(options.out);
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
Result watched_run(const Case& c, const RunOptions& options, const RunFiles& files, const RunOfCase& runner,
                   ProgressOfRun& progress) {
  std::optional<SignalWatch> signals;  // until the first step a signal ends the program at once
  const Context context{.files = files,
                        .threads = options.threads,
                        .observe =
                            [&](const Moment& m) {
                              if (!signals) signals.emplace();
                              progress.observe(m);
                            },
                        .stop = [&] { return signals && signals->stop_requested(); },
                        .keep = [&] { return signals && signals->take_checkpoint_request(); },
                        .note = options.quiet ? Note{} : Note(print_note)};
  try {
    const Result result = runner(c, context);
    progress.finish(result.end == RunEnd::stopped ? "stopped" : "done");
    return result;
  } catch (const DivergedError&) {
    progress.give_up("diverged");
    throw;
  } catch (...) {
    progress.give_up("failed");
    throw;
  }
}

/// `command`: that the user gave, "run" or "jet".
int run_into_directory(const std::string& command, const Case& c, RunOptions options,
                       const RunOfCase& runner) {
  const auto directory = directory_of(c, options);
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
  ProgressOfRun progress(c, options, directory);
  const RunFiles files{directory, options.force, options.resume, typed, here(), options.overrides};
  const Result result = watched_run(c, options, files, runner, progress);
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
  const auto directory = directory_of(c, options);
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
  const CoupledModel model(c, planned_inflow(c));
  if (!quiet) print_step(c, model);
  return exit_done;
}

int run_case(const Case& c, const RunOptions& options) {
  if (options.dry_run) return plan_case(c, options.quiet);
  return run_into_directory("run", c, options, run);
}

std::optional<nlohmann::ordered_json> result_of(const Case& c, const std::filesystem::path& directory,
                                                int threads) {
  const RunOptions options{.out = directory.string(), .threads = threads, .force = true, .quiet = true};
  const std::string command = command_line_of("run", c, options);
  ProgressOfRun progress(c, options, directory);
  const RunOfCase any = [](const Case& of, const Context& context) {
    return is_jet_case(of) ? run_jet(of, kBoxHeight, context) : run(of, context);
  };
  const Result r = watched_run(c, options, {directory, true, false, command, command}, any, progress);
  if (r.end == RunEnd::stopped) return std::nullopt;
  return r.quantities;
}

int jet_case(const Case& c, const RunOptions& options) {
  const auto [jet, kept_at] = jet_of(c);
  if (options.sweep) return sweep(jet, options);
  return run_into_directory("jet", jet, options, [kept_at = kept_at](const Case& of, const Context& context) {
    return run_jet(of, kept_at, context);
  });
}

}  // namespace ejecta
