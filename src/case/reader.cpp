#include "case/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <map>

#include "base/text.hpp"
#include "base/units.hpp"
#include "case/read_value.hpp"
#include "case/schema.hpp"
#include "case/toml.hpp"

namespace ejecta {
namespace {

std::vector<std::string> split_path(const std::string& path) {
  std::vector<std::string> parts;
  for (std::size_t start = 0; start <= path.size();) {
    const std::size_t dot = std::min(path.find('.', start), path.size());
    parts.push_back(path.substr(start, dot - start));
    start = dot + 1;
  }
  return parts;
}

/// The element of a list by number or by its `name`.
Node* element(Node& list, const std::string& which) {
  std::size_t n = 0;
  const auto [end, error] = std::from_chars(which.data(), which.data() + which.size(), n);
  if (error == std::errc() && end == which.data() + which.size())
    return n < list.children.size() ? &list.children[n] : nullptr;
  for (Node& child : list.children) {
    const Node* name = child.find("name");
    const auto* text = name ? std::get_if<std::string>(&name->value) : nullptr;
    if (text && *text == which) return &child;
  }
  return nullptr;
}

/// The value's line usually starts with its key: point at the key rather than the value.
Place place_of_key(const Node& node) {
  Place place = node.place;
  const std::string_view line = place.line();
  const std::size_t column = std::min(place.column(), line.size());
  const auto at = line.substr(0, column + node.key.size()).rfind(node.key);
  if (at == std::string_view::npos) return place;
  place.offset = place.offset - place.column() + at;
  place.length = node.key.size();
  return place;
}

class CaseReader {
 public:
  CaseReader(Case& c, std::vector<Problem>& problems)
      : case_(c), problems_(problems), sections_(sections(c)) {}

  void read(const Node& root) {
    for (const Section& s : sections_) {
      if (s.name == "fluid") ambient_ = case_.environment.pressure;
      read_section(s, find(root, s.name), root);
    }
    refuse_unknown(root, "", "", {});
  }

 private:
  static const Node* find(const Node& root, const std::string& name) {
    const Node* node = &root;
    for (const std::string& part : split_path(name)) {
      node = node->is_table() ? node->find(part) : nullptr;
      if (!node) return nullptr;
    }
    return node;
  }

  void read_section(const Section& s, const Node* node, const Node& root) {
    if (!node) {
      if (!s.repeated) require(s.keys(0), nullptr, s.name, root.place);
      return;
    }
    if (!s.repeated) {
      if (!node->is_table()) return wrong_kind(*node, s);
      if (s.enabled) *s.enabled = true;
      read_table(*node, s.keys(0), s.name);
      return;
    }
    if (!node->is_list() || std::any_of(node->children.begin(), node->children.end(),
                                        [](const Node& n) { return !n.is_table(); }))
      return wrong_kind(*node, s);
    for (std::size_t n = 0; n < node->children.size(); ++n) {
      s.append();
      read_table(node->children[n], s.keys(n), fmt::format("{}.{}", s.name, n));
    }
  }

  void wrong_kind(const Node& node, const Section& s) {
    const std::string header = s.repeated ? "[[" + s.name + "]]" : "[" + s.name + "]";
    problems_.push_back({.key = s.name,
                         .what = kind_words(node) + " where a section is needed",
                         .expected = "the section " + header,
                         .example = header,
                         .place = node.place});
  }

  void read_table(const Node& table, const std::vector<Key>& keys, const std::string& path) {
    for (const Key& key : keys)
      if (const Node* node = table.find(key.name))
        read_value(*node, key, path + "." + key.name, ambient_, problems_);
    require(keys, &table, path, table.place);
    known_keys_[path] = keys;
  }

  void require(const std::vector<Key>& keys, const Node* table, const std::string& path, const Place& place) {
    for (const Key& key : keys)
      if (key.required && !(table && table->find(key.name)))
        problems_.push_back({.key = path + "." + key.name,
                             .what = "missing",
                             .expected = expectation(key),
                             .example = fmt::format("[{}] {} = {}", path, key.name, example(key)),
                             .place = place});
  }

  /// Names allowed below a section: its keys and the next part of the names of deeper sections.
  std::vector<std::string> allowed(const std::string& section, const std::string& path) const {
    std::vector<std::string> names;
    if (const auto it = known_keys_.find(path); it != known_keys_.end())
      for (const Key& key : it->second) names.push_back(key.name);
    const std::string prefix = section.empty() ? "" : section + ".";
    for (const Section& s : sections_)
      if (s.name.starts_with(prefix) && s.name.size() > prefix.size())
        names.push_back(s.name.substr(prefix.size(), s.name.find('.', prefix.size()) - prefix.size()));
    return names;
  }

  bool is_section_part(const std::string& section) const {
    return std::any_of(sections_.begin(), sections_.end(), [&](const Section& s) {
      return s.name == section || s.name.starts_with(section + ".");
    });
  }

  void refuse_unknown(const Node& table, const std::string& section, const std::string& path,
                      const std::vector<std::string>&) {
    const std::vector<std::string> names = allowed(section, path);
    for (const Node& child : table.children) {
      const std::string child_section = section.empty() ? child.key : section + "." + child.key;
      const std::string child_path = path.empty() ? child.key : path + "." + child.key;
      if (std::find(names.begin(), names.end(), child.key) == names.end()) unknown(child, child_path, names);
      else if (!is_section_part(child_section)) continue;
      else if (child.is_table()) refuse_unknown(child, child_section, child_path, {});
      else
        for (std::size_t n = 0; n < child.children.size(); ++n)
          if (child.children[n].is_table())
            refuse_unknown(child.children[n], child_section, fmt::format("{}.{}", child_path, n), {});
    }
  }

  void unknown(const Node& node, const std::string& path, const std::vector<std::string>& names) {
    Problem p{
        .key = path, .what = "unknown key", .nearest = nearest(node.key, names), .place = place_of_key(node)};
    if (p.nearest.empty()) {
      std::vector<std::string> elsewhere;
      for (const auto& [known_path, keys] : all_keys())
        for (const Key& key : keys)
          if (key.name == node.key) elsewhere.push_back(known_path + "." + key.name);
      if (!elsewhere.empty()) p.nearest = elsewhere.front();
    }
    std::vector<std::string> unique;
    for (const std::string& name : names)
      if (std::find(unique.begin(), unique.end(), name) == unique.end()) unique.push_back(name);
    p.expected = fmt::format("one of {}", joined(unique));
    problems_.push_back(p);
  }

  std::vector<std::pair<std::string, std::vector<Key>>> all_keys() const {
    std::vector<std::pair<std::string, std::vector<Key>>> all;
    for (const Section& s : sections_)
      if (s.count() > 0) all.emplace_back(s.name, s.keys(0));
    return all;
  }

  Case& case_;
  std::vector<Problem>& problems_;
  std::vector<Section> sections_;
  std::map<std::string, std::vector<Key>> known_keys_;
  double ambient_ = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace

void read_case(const Node& root, Case& c, std::vector<Problem>& problems) {
  CaseReader(c, problems).read(root);
}

Place locate(const Node& root, const std::string& path) {
  Node* node = const_cast<Node*>(&root);
  for (const std::string& part : split_path(path)) {
    Node* next = node->is_list() ? element(*node, part) : node->is_table() ? node->find(part) : nullptr;
    if (!next) break;
    node = next;
  }
  return node->place;
}

void apply_override(Node& root, const std::string& assignment, std::vector<Problem>& problems) {
  const auto equals = assignment.find('=');
  const auto wrong = [&](const std::string& what) {
    problems.push_back({.key = "--set " + assignment,
                        .what = what,
                        .expected = "section.key=value",
                        .example = "--set run.end_time=\"8 ms\""});
  };
  if (equals == std::string::npos || equals == 0) return wrong("no key=value");
  const std::string path = assignment.substr(0, equals), value = assignment.substr(equals + 1);
  std::vector<std::string> parts = split_path(path);
  const std::string key = parts.back();
  parts.pop_back();

  // A quantity or word may stand without the quotes that a shell would eat.
  Node parsed;
  for (const std::string& text : {key + " = " + value, key + " = \"" + value + "\""}) {
    std::vector<Problem> unreadable;
    parsed = parse_toml(std::make_shared<Source>(Source{"--set " + assignment, text}), unreadable);
    if (unreadable.empty() && parsed.children.size() == 1) break;
    parsed.children.clear();
  }
  if (parsed.children.empty()) return wrong("the value cannot be read");

  Node* node = &root;
  for (const std::string& part : parts) {
    if (node->is_list()) {
      node = element(*node, part);
      if (!node) return wrong(fmt::format("no element \"{}\" in the list", part));
      continue;
    }
    if (!node->is_table()) return wrong(fmt::format("\"{}\" is inside a value", part));
    if (Node* next = node->find(part)) {
      node = next;
    } else {
      Node table;
      table.key = part;
      table.place = parsed.children.front().place;
      node->children.push_back(table);
      node = &node->children.back();
    }
  }
  if (node->is_list()) return wrong("this is a list: say which element, e.g. body.0.mass");
  if (!node->is_table()) return wrong(fmt::format("\"{}\" is inside a value", key));
  if (Node* old = node->find(key)) *old = parsed.children.front();
  else node->children.push_back(parsed.children.front());
}

}  // namespace ejecta
