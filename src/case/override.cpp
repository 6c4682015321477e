#include "case/override.hpp"

#include <fmt/format.h>

#include <utility>

#include "case/node_path.hpp"
#include "case/toml.hpp"

namespace ejecta {
namespace {

/// A table of one key, or none if the value cannot be read. A quantity or word may stand without the quotes
/// that a shell eats.
Node parse_value(const std::string& key, const std::string& value, const std::string& origin) {
  for (const std::string& text :
       {fmt::format("{} = {}", key, value), fmt::format("{} = \"{}\"", key, value)}) {
    std::vector<Problem> unreadable;
    Node parsed = parse_toml(std::make_shared<Source>(Source{origin, text}), unreadable);
    if (unreadable.empty() && parsed.children.size() == 1) return parsed;
  }
  return {};
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

  const Node parsed = parse_value(key, value, "--set " + assignment);
  if (parsed.children.empty()) return wrong("the value cannot be read");
  if (const std::string refusal = put_value(root, path, parsed.children.front()); !refusal.empty())
    wrong(refusal);
}

std::string put_value(Node& root, const std::string& path, Node value) {
  std::vector<std::string> parts = split_path(path);
  const std::string key = parts.back();
  parts.pop_back();
  Node* node = &root;
  for (const std::string& part : parts) {
    if (node->is_list()) {
      Node* next = const_cast<Node*>(element(*node, part));
      if (!next) return fmt::format("no element \"{}\" in the list", part);
      node = next;
      continue;
    }
    if (!node->is_table()) return fmt::format("\"{}\" is inside a value", part);
    if (Node* next = node->find(part)) {
      node = next;
    } else {
      Node table;
      table.key = part;
      table.place = value.place;
      node->children.push_back(table);
      node = &node->children.back();
    }
  }
  if (node->is_list()) return "this is a list: say which element, e.g. body.0.mass";
  if (!node->is_table()) return fmt::format("\"{}\" is inside a value", key);
  value.key = key;
  if (Node* old = node->find(key)) *old = std::move(value);
  else node->children.push_back(std::move(value));
  return "";
}

}  // namespace ejecta
