#include "case/node_path.hpp"

#include <algorithm>
#include <charconv>

namespace ejecta {

std::vector<std::string> split_path(const std::string& path) {
  std::vector<std::string> parts;
  for (std::size_t start = 0; start <= path.size();) {
    const std::size_t dot = std::min(path.find('.', start), path.size());
    parts.push_back(path.substr(start, dot - start));
    start = dot + 1;
  }
  return parts;
}

const Node* find_section(const Node& root, const std::string& name) {
  const Node* node = &root;
  for (const std::string& part : split_path(name)) {
    node = node->is_table() ? node->find(part) : nullptr;
    if (!node) return nullptr;
  }
  return node;
}

const Node* element(const Node& list, const std::string& which) {
  std::size_t n = 0;
  const auto [end, error] = std::from_chars(which.data(), which.data() + which.size(), n);
  if (error == std::errc() && end == which.data() + which.size())
    return n < list.children.size() ? &list.children[n] : nullptr;
  for (const Node& child : list.children) {
    const Node* name = child.find("name");
    const auto* text = name ? std::get_if<std::string>(&name->value) : nullptr;
    if (text && *text == which) return &child;
  }
  return nullptr;
}

const Node* find_node(const Node& root, const std::string& path) {
  const Node* node = &root;
  for (const std::string& part : split_path(path)) {
    node = node->is_list() ? element(*node, part) : node->find(part);
    if (!node) return nullptr;
  }
  return node;
}

Place locate(const Node& root, const std::string& path) {
  const Node* node = &root;
  for (const std::string& part : split_path(path)) {
    const Node* next = node->is_list() ? element(*node, part) : node->find(part);
    if (!next) break;
    node = next;
  }
  return node->place;
}

}  // namespace ejecta
