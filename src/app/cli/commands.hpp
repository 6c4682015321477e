#pragma once
#include <CLI/CLI.hpp>
#include <functional>

#include "base/error.hpp"

/// The commands of `ejecta`. Each function adds one command with its options, help and an example; when the
/// command is given, `action` becomes what it does and returns an ExitCode.
namespace ejecta {

using Action = std::function<int()>;

void add_run(CLI::App& app, Action& action);
void add_check(CLI::App& app, Action& action);
void add_plan(CLI::App& app, Action& action);
void add_explain(CLI::App& app, Action& action);
void add_new(CLI::App& app, Action& action);
void add_jet(CLI::App& app, Action& action);
void add_validate(CLI::App& app, Action& action);
void add_bench(CLI::App& app, Action& action);
void add_report(CLI::App& app, Action& action);
void add_cache(CLI::App& app, Action& action);
void add_study(CLI::App& app, Action& action);
void add_map(CLI::App& app, Action& action);
void add_campaign(CLI::App& app, Action& action);
void add_serve(CLI::App& app, Action& action);
void add_table(CLI::App& app, Action& action);
void add_paraview(CLI::App& app, Action& action);
void add_sort(CLI::App& app, Action& action);

/// Tells the user what is wrong with the input.
void print_input_error(const InputError& e);
/// The whole program: parses the command line, does it and turns exceptions into exit codes.
int run_command_line(int argc, const char* const* argv);

}  // namespace ejecta
