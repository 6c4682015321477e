#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "app/cli/case_options.hpp"
#include "app/cli/commands.hpp"
#include "app/simulation.hpp"
#include "base/error.hpp"
#include "base/exit_code.hpp"
#include "bench/bench.hpp"

/// The commands that compute: run, plan, jet, bench.
namespace ejecta {
namespace {

struct RunCommand {
  CaseOptions input;
  RunOptions run;
};

void add_run_options(CLI::App& command, RunCommand& o) {
  add_case_options(command, o.input);
  command.add_option("--out", o.run.out, "Run directory (default: the name of the case with .run)")
      ->type_name("DIR");
  add_threads(command, o.run.threads);
  command.add_flag("--force", o.run.force, "Overwrite the run in that directory");
  command.add_flag("-q,--quiet", o.run.quiet, "Print nothing but errors");
  command.add_flag("-v,--verbose", o.run.verbose, "Print every step");
}

/// Options that contradict each other.
void require_sense(const RunOptions& o) {
  if (o.force && o.resume)
    throw InputError("--resume goes on with a run, --force starts anew: give one of them");
  if (o.quiet && o.verbose) throw InputError("--quiet or --verbose: give one of them");
}

}  // namespace

void add_run(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("run", "Runs a case");
  auto o = std::make_shared<RunCommand>();
  add_run_options(*command, *o);
  command->add_flag("--resume", o->run.resume, "Continue from the last good checkpoint");
  command->add_flag("--dry-run", o->run.dry_run, "Set everything up, take no step");
  command->footer(
      "^C, SIGTERM and `timeout` stop a run so that --resume can go on; SIGUSR1 writes a checkpoint.\n\n"
      "Examples:\n  ejecta run cases/tutorial.toml\n"
      "  ejecta run cases/paper/10mm-cubic.toml --set valve.supply_pressure=\"600 kPa gauge\" --out "
      "soft.run\n"
      "  ejecta run cases/paper/10mm-cubic.toml --resume");
  command->callback([o, &action] {
    action = [o] {
      require_sense(o->run);
      o->run.overrides = o->input.overrides;
      return run_case(load_and_warn(o->input, o->run.quiet), o->run);
    };
  });
}

void add_plan(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("plan", "Prints the operators of a step with their equations");
  auto o = std::make_shared<CaseOptions>();
  add_case_options(*command, *o);
  command->footer("Example:\n  ejecta plan cases/paper/10mm-cubic.toml");
  command->callback([o, &action] { action = [o] { return plan_case(load_and_warn(*o)); }; });
}

void add_jet(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("jet", "Computes only the jet and stores it for later runs");
  auto o = std::make_shared<RunCommand>();
  add_run_options(*command, *o);
  command->add_flag("--resume", o->run.resume, "Continue from the last good checkpoint");
  command->add_flag("--sweep", o->run.sweep,
                    "Instead: the settled jets of jet.sweep_pressures and jet.sweep_velocities, and the "
                    "equivalent velocity of each pressure");
  command->footer(
      "Examples:\n  ejecta jet cases/paper/jet-700kPa.toml\n  ejecta jet cases/paper/jet-700kPa.toml "
      "--sweep");
  command->callback([o, &action] {
    action = [o] {
      require_sense(o->run);
      o->run.overrides = o->input.overrides;
      return jet_case(load_and_warn(o->input, o->run.quiet), o->run);
    };
  });
}

void add_bench(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("bench", "Cell-steps and particle-steps per second on standard cases, per operator");
  auto o = std::make_shared<BenchOptions>();
  add_threads(*command, o->threads);
  command->add_option("--steps", o->steps, "Timed steps")
      ->type_name("N")
      ->check(CLI::Range(1, 100000).description(""))
      ->capture_default_str();
  command->add_option("--only", o->only, "Measure nothing else")
      ->check(CLI::IsMember({"flow", "dem", "settled", "grains"}));
  command->footer("Example:\n  ejecta bench --threads 2\n  ejecta bench --threads 1 --only dem");
  command->callback([o, &action] {
    action = [o] {
      bench(*o, [](const std::string& line) {
        fmt::print("{}\n", line);
        std::fflush(stdout);
      });
      return int{exit_done};
    };
  });
}

}  // namespace ejecta
