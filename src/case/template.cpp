#include "case/template.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>

#include "base/error.hpp"
#include "base/text.hpp"
#include "case/documented.hpp"
#include "case/node_path.hpp"
#include "case/schema.hpp"
#include "case/template_texts.hpp"
#include "case/toml.hpp"

namespace ejecta {
namespace {

/// What may stand behind "key = ": for a key left out, its default or else an example.
std::string default_value(const Key& key) {
  const std::string value = key.unset.empty() && key.example.empty() ? value_text(key) : "";
  return value.empty() ? example(key) : value;
}

/// The keys of one table: those the text gives and, if `all`, the others commented out.
std::string table_text(const Section& s, const Node& table, bool all) {
  std::string text = fmt::format("\n# {}\n", s.help);
  text += fmt::format(fmt::runtime(s.repeated ? "[[{}]]\n" : "[{}]\n"), s.name);
  for (const Key& key : s.keys(0)) {
    const Node* node = table.find(key.name);
    if (!node && !all) continue;
    const std::string assignment = node ? fmt::format("{} = {}", key.name, node->place.text())
                                        : fmt::format("# {} = {}", key.name, default_value(key));
    const std::string unset = node || key.unset.empty() ? "" : fmt::format(" (default: {})", key.unset);
    text += fmt::format("{:<52}  # {}{}\n", assignment, key.help, unset);
  }
  return text;
}

/// Sections with the same keys, such as the six faces: it is enough to list all keys once.
std::string group(const Section& s) {
  if (s.repeated) return s.name;
  return s.name.starts_with("boundary.") ? "boundary" : s.name.starts_with("grid.") ? "axis" : s.name;
}

}  // namespace

const std::vector<Word>& template_kinds() {
  static const std::vector<Word> kinds = [] {
    std::vector<Word> list;
    for (const TemplateText& t : template_texts()) list.push_back({t.kind, t.help});
    return list;
  }();
  return kinds;
}

std::string case_template(const std::string& kind) {
  std::vector<std::string> known;
  for (const TemplateText& t : template_texts()) {
    known.push_back(t.kind);
    if (t.kind != kind) continue;
    std::vector<Problem> problems;
    const Node root = parse_toml(std::make_shared<Source>(Source{kind, t.text}), problems);
    if (!problems.empty()) throw Error(render(problems));
    std::string text = fmt::format(
        "# {}\n# `ejecta explain` lists all keys, `ejecta check FILE` looks at this file, `ejecta run FILE` "
        "runs it.\n",
        t.help);
    Case c = documented_case();
    std::vector<std::string> unused;
    std::set<std::string> listed;
    for (const Section& s : sections(c)) {
      const Node* node = find_section(root, s.name);
      if (!node && !s.name.starts_with("boundary.") && !s.name.starts_with("grid."))
        unused.push_back(header(s));
      if (!node || (!s.repeated && !node->is_table())) continue;
      if (!s.repeated) text += table_text(s, *node, listed.insert(group(s)).second);
      else
        for (const Node& element : node->children)
          text += table_text(s, element, listed.insert(group(s)).second);
    }
    return text + fmt::format("\n# Other sections: {}\n", joined(unused));
  }
  const std::string close = nearest(kind, known);
  throw InputError(fmt::format("no kind of case is called \"{}\"{} (known: {})", kind,
                               close.empty() ? "" : fmt::format(", nearest is \"{}\"", close),
                               joined(known)));
}

}  // namespace ejecta
