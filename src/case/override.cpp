#include "case/override.hpp"

#include <fmt/format.h>

#include <utility>

#include "base/text.hpp"
#include "case/node_path.hpp"
#include "case/toml.hpp"

namespace ejecta {
namespace {

/// A table of one key, or what keeps the value from being read. A quantity or word may stand without the
/// quotes that a shell eats.
Node parse_value(const std::string& key, const std::string& value, const std::string& origin,
                 std::vector<Problem>& problems) {
  std::vector<Problem> as_written;
  for (const std::string& text :
       {fmt::format("{} = {}", key, value), fmt::format("{} = \"{}\"", key, value)}) {
    std::vector<Problem> unreadable;
    Node parsed = parse_toml(std::make_shared<Source>(Source{origin, text}), unreadable);
    if (unreadable.empty() && parsed.children.size() == 1) return parsed;
    if (as_written.empty()) as_written = std::move(unreadable);
  }
  if (as_written.empty()) as_written.push_back({.what = "this is more than one value"});
  problems.insert(problems.end(), as_written.begin(), as_written.end());
  return {};
}

std::string path_of(const std::vector<std::string>& parts, std::size_t count) {
  return joined({parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(count)}, ".");
}

/// What the elements of a list are called in a path: their `name`, else their number.
std::vector<std::string> names_of_elements(const Node& list) {
  std::vector<std::string> names;
  for (const Node& child : list.children) {
    const Node* name = child.find("name");
    const auto* text = name ? std::get_if<std::string>(&name->value) : nullptr;
    names.push_back(text ? *text : std::to_string(names.size()));
  }
  return names;
}

/// `parts` up to `end` name a list of which an element must be said, the rest is a key of one.
Problem which_element(const Node& list, std::vector<std::string> parts, std::size_t end,
                      const std::string& what) {
  const std::vector<std::string> names = names_of_elements(list);
  const std::string owner = path_of(parts, end);
  if (names.empty()) return {.what = what, .expected = fmt::format("a [[{}]] in the case", owner)};
  const bool one_is_said = end + 1 < parts.size();
  if (!one_is_said) parts.insert(parts.begin() + static_cast<std::ptrdiff_t>(end), "");
  const std::string close = nearest(parts[end], names);
  parts[end] = close.empty() ? names.front() : close;
  return {.what = what,
          .expected = fmt::format("an element of {} by its name or number: {}", owner, joined(names)),
          .nearest = path_of(parts, parts.size())};
}

Problem inside_a_value(const std::vector<std::string>& parts, std::size_t end) {
  const std::string owner = path_of(parts, end);
  return {.what = fmt::format("{} is a value, \"{}\" cannot be inside it", owner, parts[end]),
          .nearest = owner};
}

}  // namespace

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
  const std::string key = split_path(path).back();

  const Node parsed = parse_value(key, value, "--set " + assignment, problems);
  if (parsed.children.empty()) return;
  if (auto refusal = put_value(root, path, parsed.children.front())) {
    refusal->key = "--set " + assignment;
    if (!refusal->nearest.empty()) refusal->example = fmt::format("--set {}=\"{}\"", refusal->nearest, value);
    problems.push_back(*refusal);
  }
}

std::optional<Problem> put_value(Node& root, const std::string& path, Node value) {
  const std::vector<std::string> parts = split_path(path);
  Node* node = &root;
  for (std::size_t n = 0; n + 1 < parts.size(); ++n) {
    if (node->is_list()) {
      Node* next = const_cast<Node*>(element(*node, parts[n]));
      if (!next)
        return which_element(*node, parts, n, fmt::format("{} has no \"{}\"", path_of(parts, n), parts[n]));
      node = next;
      continue;
    }
    if (!node->is_table()) return inside_a_value(parts, n);
    if (Node* next = node->find(parts[n])) {
      node = next;
    } else {
      Node table;
      table.key = parts[n];
      table.place = value.place;
      node->children.push_back(table);
      node = &node->children.back();
    }
  }
  if (node->is_list()) {
    const std::size_t end = parts.size() - 1;
    return which_element(*node, parts, end, fmt::format("{} is a list", path_of(parts, end)));
  }
  if (!node->is_table()) return inside_a_value(parts, parts.size() - 1);
  value.key = parts.back();
  if (Node* old = node->find(value.key)) *old = std::move(value);
  else node->children.push_back(std::move(value));
  return {};
}

}  // namespace ejecta
