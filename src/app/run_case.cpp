#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <iostream>
#include <optional>

#include "app/exit_code.hpp"
#include "app/signals.hpp"
#include "app/simulation.hpp"
#include "base/error.hpp"
#include "base/parallel.hpp"
#include "output/progress.hpp"
#include "output/run_directory.hpp"
#include "output/verdict.hpp"
#include "simulation/run.hpp"

namespace ejecta {
namespace {

void print_note(const std::string& line) { fmt::print(stderr, "{}\n", line); }

void print_verdict(const Result& result, const std::filesystem::path& run) {
  fmt::print("{}\n", output::verdict_sentence(result.quantities));
  fmt::print("results: {}\n", (run / "result.json").string());
  if (std::filesystem::exists(run / "report.html"))
    fmt::print("report:  {}\n", (run / "report.html").string());
}

void print_step(const CoupledModel& model) {
  fmt::print("One step of {}:\n", model.config().path);
  int n = 0;
  for (const auto& op : model.operator_times()) fmt::print("  {:2}. {:<26} {}\n", ++n, op.name, op.equation);
}

std::string start_line(const Case& c, const Moment& m, const std::filesystem::path& directory) {
  const auto bodies = m.model.particles().bodies().size();
  return fmt::format("{}: {} cells, {} bod{}, {} thread{} -> {}{}", c.path,
                     m.model.flow() ? m.model.grid().cells() : 0, bodies, bodies == 1 ? "y" : "ies",
                     thread_count(), thread_count() == 1 ? "" : "s", directory.string(),
                     m.step > 0 ? fmt::format(", from t = {:.3f} ms", 1e3 * m.time) : "");
}

/// How far a run is, on the terminal and in its progress.json.
class ProgressOfRun {
 public:
  ProgressOfRun(const Case& c, const RunOptions& options, std::filesystem::path directory)
      : case_(c), options_(options), directory_(std::move(directory)) {}

  void observe(const Moment& m) {
    last_ = {m.time, m.busy_until,      m.step,
             m.dt,   m.model.courant(), m.model.air() ? m.model.grid().cells() : 0};
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

int run_into(const std::filesystem::path& directory, const Case& c, RunOptions options) {
  const std::string typed = command_line_of("run", c, options);
  options.out = directory.string();
  const auto command = [&c](const RunOptions& o) { return command_line_of("run", c, o); };
  std::optional<SignalWatch> signals;  // until the first step a signal ends the program at once
  ProgressOfRun progress(c, options, directory);
  Context context{
      .files = RunFiles{directory, options.force, options.resume, typed, command(options), options.overrides},
      .threads = options.threads,
      .observe =
          [&](const Moment& m) {
            if (!signals) signals.emplace();
            progress.observe(m);
          },
      .stop = [&] { return signals->stop_requested(); },
      .keep = [&] { return signals->take_checkpoint_request(); },
      .note = print_note};
  Result result;
  try {
    result = run(c, context);
  } catch (const DivergedError&) {
    progress.give_up("diverged");
    throw;
  } catch (...) {
    progress.give_up("failed");
    throw;
  }
  progress.finish(result.end == RunEnd::stopped ? "stopped" : "done");
  if (result.end == RunEnd::stopped) {
    progress.note(fmt::format("continue with\n  {} --resume", command(options)));
    return exit_stopped;
  }
  if (!options.quiet) {
    if (options.verbose || c.flow.solver != FlowSolver::none)
      fmt::print("{}\n", output::operator_table(result.operators, result.wall_time));
    print_verdict(result, directory);
  }
  if (result.later_end) {
    options.overrides.push_back(fmt::format("run.end_time={:.0f} ms", 1e3 * *result.later_end));
    progress.note(fmt::format("go on with\n  {} --resume", command(options)));
  }
  return exit_code_of(result.end);
}

}  // namespace

int run_case(const Case& c, const RunOptions& options) {
  if (options.dry_run) {
    const CoupledModel model(c, print_note);
    if (!options.quiet) print_step(model);
    return exit_done;
  }
  const auto directory =
      options.out.empty() ? output::RunDirectory::default_path(c.path) : std::filesystem::path(options.out);
  if (options.resume)
    if (const auto result = finished_run(c, directory)) {
      if (!options.quiet) {
        fmt::print("{} is finished: nothing to compute\n", directory.string());
        print_verdict(*result, directory);
      }
      return exit_code_of(result->end);
    }
  return run_into(directory, c, options);
}

int plan_case(const Case& c) {
  print_step(CoupledModel(c, print_note));
  return exit_done;
}

}  // namespace ejecta
