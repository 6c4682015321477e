#include <fmt/format.h>

#include <cstdio>

#include "app/cli/commands.hpp"
#include "app/exit_code.hpp"
#include "base/error.hpp"
#include "base/text.hpp"
#include "output/build_info.hpp"

namespace ejecta {

namespace {

int unknown_command(const CLI::App& app, const std::string& word) {
  std::vector<std::string> known;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    known.push_back(command->get_name());
  const std::string close = nearest(word, known);
  fmt::print(stderr, "error: there is no command \"{}\"{}\n  commands:  {}\n", word,
             close.empty() ? "" : fmt::format(", nearest is \"{}\"", close), joined(known));
  return exit_bad_input;
}

bool is_command(const CLI::App& app, const std::string& word) {
  return !app.get_subcommands([&](const CLI::App* command) { return command->get_name() == word; }).empty();
}

}  // namespace

int run_command_line(int argc, const char* const* argv) {
  CLI::App app(
      "Ejecta predicts which particles an air-jet sorter ejects: it computes the pulsed air jet, the "
      "particles\n"
      "and what they do to each other.\n\n"
      "First steps:\n"
      "  ejecta new > my-case.toml      a commented case\n"
      "  ejecta check my-case.toml      what the run will be\n"
      "  ejecta run my-case.toml        runs it",
      "ejecta");
  app.set_version_flag("--version", std::string(output::version()));
  app.require_subcommand(1);
  app.failure_message(CLI::FailureMessage::simple);
  Action action;
  for (auto* add : {add_run, add_check, add_plan, add_explain, add_new, add_jet, add_validate, add_bench,
                    add_report, add_cache})
    add(app, action);
  if (argc > 1 && argv[1][0] != '-' && !is_command(app, argv[1])) return unknown_command(app, argv[1]);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? exit_done : exit_bad_input;
  }
  try {
    return action();
  } catch (const InputError& e) {
    fmt::print(stderr, "{}\n", e.what());
    return exit_bad_input;
  } catch (const DivergedError& e) {
    fmt::print(stderr, "{}\n", e.what());
    return exit_diverged;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "error: not enough memory; `ejecta check CASE` says how much a case needs\n");
    return exit_failure;
  } catch (const std::exception& e) {
    fmt::print(stderr, "error: {}\n", e.what());
    return exit_failure;
  }
}

}  // namespace ejecta
