#include "case/explain.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "app/cli/commands.hpp"
#include "app/cli/documents.hpp"
#include "base/exit_code.hpp"
#include "base/text.hpp"
#include "case/template.hpp"
#include "simulation/help.hpp"

/// The commands that only tell: explain, new.
namespace ejecta {

void add_explain(CLI::App& app, Action& action) {
  struct Options {
    std::vector<std::string> topic;
    bool markdown = false, schema = false, man = false, completion = false;
  };
  CLI::App* command =
      app.add_subcommand("explain", "What the keys of a case file mean: unit, default, range, source");
  auto o = std::make_shared<Options>();
  command->add_option("TOPIC", o->topic, "A section, a key or words to search for; none: all keys")
      ->type_name("");
  command->add_flag("--markdown", o->markdown, "The whole reference page");
  command->add_flag("--json-schema", o->schema, "A JSON schema for editors");
  command->add_flag("--man", o->man, "The man page, e.g. ejecta explain --man | man -l -");
  command->add_flag("--completion", o->completion,
                    "Completion for bash: source <(ejecta explain --completion)");
  command->footer(
      "Examples:\n  ejecta explain valve.rise_time\n  ejecta explain splitter\n  ejecta explain turbulence");
  command->callback([o, &app, &action] {
    action = [o, &app] {
      fmt::print("{}", o->man          ? man_page(app)
                       : o->completion ? bash_completion(app)
                       : o->markdown   ? reference_page()
                       : o->schema     ? json_schema()
                                       : help_on(joined(o->topic, " ")));
      return int{exit_done};
    };
  });
}

void add_new(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("new", "Prints a commented case to start from");
  auto kind = std::make_shared<std::string>(template_kinds().front().name);
  std::string known;
  for (const Word& w : template_kinds()) known += fmt::format("\n  {:<12} {}", w.name, w.help);
  command->add_option("KIND", *kind, "Kind of case (default: ejection)")->type_name("");
  command->footer("Kinds:" + known + "\n\nExample:\n  ejecta new ejection > my-case.toml");
  command->callback([kind, &action] {
    action = [kind] {
      fmt::print("{}", case_template(*kind));
      return int{exit_done};
    };
  });
}

}  // namespace ejecta
