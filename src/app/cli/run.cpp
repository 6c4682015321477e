#include <memory>

#include "app/cli/case_options.hpp"
#include "app/cli/commands.hpp"
#include "app/simulation.hpp"

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
  command.add_option("--threads", o.run.threads, "Threads (default: all cores)")->check(CLI::Range(1, 1024));
  command.add_flag("--force", o.run.force, "Overwrite the run directory");
  command.add_flag("-q,--quiet", o.run.quiet, "Print errors only");
  command.add_flag("-v,--verbose", o.run.verbose, "Print every step");
}

}  // namespace

void add_run(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("run", "Runs a case");
  auto o = std::make_shared<RunCommand>();
  add_run_options(*command, *o);
  command->add_flag("--resume", o->run.resume, "Continue from the last good checkpoint");
  command->add_flag("--dry-run", o->run.dry_run, "Set everything up, take no step");
  command->footer(
      "Example:\n  ejecta run cases/paper/10mm-cubic.toml --set valve.supply_pressure=\"600 kPa gauge\"");
  command->callback([o, &action] { action = [o] { return run_case(load_and_warn(o->input), o->run); }; });
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
  command->add_flag("--sweep", o->run.sweep,
                    "Instead: the settled jets of jet.sweep_pressures and jet.sweep_velocities, and the "
                    "equivalent velocity of each pressure");
  command->footer(
      "Examples:\n  ejecta jet cases/paper/jet-700kPa.toml\n  ejecta jet cases/paper/jet-700kPa.toml --sweep");
  command->callback([o, &action] { action = [o] { return jet_case(load_and_warn(o->input), o->run); }; });
}

void add_bench(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand(
      "bench", "Cell-steps per second on the standard case, per operator, against the machine's limit");
  auto o = std::make_shared<BenchOptions>();
  command->add_option("--threads", o->threads, "Threads (default: all cores)")->check(CLI::Range(1, 1024));
  command->add_option("--steps", o->steps, "Timed steps")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->footer("Example:\n  ejecta bench --threads 2");
  command->callback([o, &action] { action = [o] { return bench(*o); }; });
}

}  // namespace ejecta
