#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string_view>

#include "app/cli/commands.hpp"
#include "base/exit_code.hpp"
#include "base/parallel.hpp"
#include "base/shell_word.hpp"
#include "base/text.hpp"
#include "base/told.hpp"
#include "output/build_info.hpp"

namespace ejecta {

namespace {

int unknown_command(const CLI::App& app, const std::string& word) {
  std::vector<std::string> known;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    known.push_back(command->get_name());
  const std::string close = nearest(word, known);
  fmt::print(stderr, "error: {}{}\n  commands:  {}\n  a first case:  ejecta new > my-case.toml\n",
             word.empty() ? "a command is needed" : fmt::format("there is no command \"{}\"", word),
             close.empty() ? "" : fmt::format(", nearest is \"{}\"", close), joined(known));
  return exit_bad_input;
}

/// What is wrong with the words after a command, and the nearest option.
std::string wrong_words(const CLI::App& command, const CLI::ParseError& e) {
  const std::vector<std::string> left = command.remaining();
  const auto option =
      std::find_if(left.begin(), left.end(), [](const std::string& word) { return word.starts_with('-'); });
  if (option == left.end())
    return left.empty() ? e.what() : fmt::format("\"{}\" is one word too many", left.front());
  std::error_code none;
  if (std::filesystem::exists(*option, none))
    return fmt::format("\"{}\" is taken for an option\n  example:  {}", *option, path_word(*option));
  std::vector<std::string> known;
  for (const CLI::Option* o : command.get_options())
    for (const std::string& name : o->get_lnames()) known.push_back("--" + name);
  const std::string close = nearest(option->substr(0, option->find('=')), known);
  return fmt::format("there is no option \"{}\"{}", *option,
                     close.empty() ? "" : fmt::format(", nearest is \"{}\"", close));
}

std::string failure(const CLI::App* app, const CLI::Error& e) {
  const auto given = app->get_subcommands();
  const CLI::App& command = given.empty() ? *app : *given.front();
  return fmt::format("error: {}\n  help:  {}{} --help\n",
                     wrong_words(command, static_cast<const CLI::ParseError&>(e)),
                     given.empty() ? "" : app->get_name() + " ", command.get_name());
}

/// What was printed has arrived: a full disk behind `> file` shows only here.
int flushed(int code) {
  if (std::fflush(stdout) == 0) return code;
  fmt::print(stderr, "error: cannot write the output: {}\n", std::strerror(errno));
  return code == exit_done ? exit_failure : code;
}

bool is_command(const CLI::App& app, const std::string& word) {
  return !app.get_subcommands([&](const CLI::App* command) { return command->get_name() == word; }).empty();
}

}  // namespace

void print_input_error(const InputError& e) {
  // A list of the errors of a case says so itself, error by error.
  const bool list = std::string_view(e.what()).find("error: ") != std::string_view::npos;
  fmt::print(stderr, "{}{}\n", list ? "" : "error: ", told(e));
}

int run_command_line(int argc, const char* const* argv) {
  flush_denormals();
  if (argc > 1 && std::string_view(argv[1]) == "help") {  // what people type first: help, help COMMAND
    std::vector<const char*> words{argv[0], "--help"};
    if (argc > 2) words.insert(words.begin() + 1, argv[2]);
    return run_command_line(static_cast<int>(words.size()), words.data());
  }
  CLI::App app(
      "Ejecta predicts which particles an air-jet sorter ejects: it computes the pulsed air jet, the "
      "particles\n"
      "and what they do to each other.\n\n"
      "First steps:\n"
      "  ejecta new > my-case.toml      a commented case\n"
      "  ejecta check my-case.toml      what the run will be\n"
      "  ejecta run my-case.toml        runs it\n",
      "ejecta");
  app.set_version_flag("-v,--version", fmt::format("{} ({}, kernels for {})", output::version(),
                                                   output::git_revision(), output::kernels()));
  app.require_subcommand(1);
  app.get_formatter()->label("SUBCOMMAND", "COMMAND");
  app.get_formatter()->label("Positionals", "Arguments");
  app.get_formatter()->label("REQUIRED", "(required)");
  app.footer(
      "`ejecta COMMAND --help` explains a command.\n"
      "Exit codes: 0 done, 1 failure, 2 bad input, 3 diverged, 4 stopped and resumable, 5 validation "
      "failed,\n6 ended before the verdict.");
  app.failure_message(failure);
  Action action;
  for (auto* add :
       {add_run, add_check, add_plan, add_explain, add_new, add_jet, add_validate, add_bench, add_report,
        add_cache, add_study, add_map, add_campaign, add_table, add_serve, add_paraview, add_sort})
    add(app, action);
  for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    command->group("Commands");
  if (argc < 2) return unknown_command(app, "");
  if (argv[1][0] != '-' && !is_command(app, argv[1])) return unknown_command(app, argv[1]);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? exit_done : exit_bad_input;
  }
  try {
    return flushed(action());
  } catch (const InputError& e) {
    print_input_error(e);
    return exit_bad_input;
  } catch (const DivergedError& e) {
    fmt::print(stderr, "error: {}\n", e.what());
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
