#include "app/cli/documents.hpp"

#include <fmt/format.h>

#include <vector>

#include "base/text.hpp"
#include "case/documented.hpp"
#include "case/template.hpp"
#include "output/build_info.hpp"

namespace ejecta {
namespace {

std::vector<const CLI::App*> commands_of(const CLI::App& program) {
  return program.get_subcommands([](const CLI::App*) { return true; });
}

/// Text of a man page: a minus is not a hyphen, and a line does not begin with a request.
std::string roff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n')) out += "\\&";
    if (c == '-' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

std::string option_words(const CLI::Option& o) {
  std::vector<std::string> names;
  for (const std::string& name : o.get_snames()) names.push_back("-" + name);
  for (const std::string& name : o.get_lnames()) names.push_back("--" + name);
  const std::string type = o.get_type_name();
  return joined(names) + (type.empty() ? "" : " " + type);
}

std::string synopsis(const CLI::App& command) {
  std::string text;
  for (const CLI::Option* o : command.get_options())
    if (o->get_positional()) text += o->get_required() ? " " + o->get_name() : " [" + o->get_name() + "]";
  return text;
}

}  // namespace

std::string man_page(const CLI::App& program) {
  std::string text = fmt::format(".TH EJECTA 1 \"\" \"ejecta {}\"\n.SH NAME\nejecta \\- {}\n.SH SYNOPSIS\n",
                                 output::version(), "predicts which particles an air\\-jet sorter ejects");
  for (const CLI::App* command : commands_of(program))
    text +=
        fmt::format(".B ejecta {}\n{}\n.br\n", command->get_name(), roff(synopsis(*command) + " [OPTIONS]"));
  text += fmt::format(".SH DESCRIPTION\n.nf\n{}\n.fi\n", roff(program.get_description()));
  for (const CLI::App* command : commands_of(program)) {
    text += fmt::format(".SH ejecta {}\n{}.\n", command->get_name(), roff(command->get_description()));
    for (const CLI::Option* o : command->get_options())
      text += fmt::format(".TP\n.B {}\n{}\n", roff(o->get_positional() ? o->get_name() : option_words(*o)),
                          roff(o->get_description()));
    text += fmt::format(".PP\n.nf\n{}\n.fi\n", roff(command->get_footer()));
  }
  return text + fmt::format(".SH EXIT STATUS\n.nf\n{}\n.fi\n", roff(program.get_footer()));
}

std::string bash_completion(const CLI::App& program) {
  std::vector<std::string> names, kinds;
  for (const CLI::App* command : commands_of(program)) names.push_back(command->get_name());
  for (const Word& kind : template_kinds()) kinds.emplace_back(kind.name);
  std::string options;
  for (const CLI::App* command : commands_of(program)) {
    std::vector<std::string> words;
    for (const CLI::Option* o : command->get_options())
      for (const std::string& name : o->get_lnames()) words.push_back("--" + name);
    options += fmt::format("    {}) words='{}' ;;\n", command->get_name(), joined(words, " "));
  }
  const std::string keys = joined(all_keys(), " ");
  return fmt::format(R"(# Completion of the words of ejecta {} for bash.
_ejecta() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} words=''
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    COMPREPLY=($(compgen -W '{}' -- "$word"))
    return
  fi
  if [[ $before == --set ]]; then
    compopt -o nospace
    COMPREPLY=($(compgen -S = -W '{}' -- "$word"))
    return
  fi
  case ${{COMP_WORDS[1]}} in
{}  esac
  if [[ $word != -* ]]; then
    case ${{COMP_WORDS[1]}} in
      explain) words='{}' ;;
      new) words='{}' ;;
      *)
        compopt -o filenames
        COMPREPLY=($(compgen -f -X '!*.toml' -- "$word") $(compgen -d -- "$word"))
        return
        ;;
    esac
  fi
  COMPREPLY=($(compgen -W "$words" -- "$word"))
}}
complete -F _ejecta ejecta
)",
                     output::version(), joined(names, " "), keys, options, keys, joined(kinds, " "));
}

}  // namespace ejecta
