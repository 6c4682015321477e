#include "case_tree.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/text.hpp"
#include "case/case_text.hpp"
#include "case/extends.hpp"
#include "case/load.hpp"
#include "case/node_path.hpp"
#include "case/override.hpp"
#include "case/toml.hpp"
#include "simulation/body_checks.hpp"
#include "validation/validation.hpp"

namespace ejecta::python {

namespace {

/// Takes a key out of the tree, if it is there.
void remove(Node& root, const std::string& path) {
  std::vector<std::string> parts = split_path(path);
  const std::string key = parts.back();
  parts.pop_back();
  Node* node = &root;
  for (const std::string& part : parts) {
    if (!node) return;
    node = node->is_list() ? const_cast<Node*>(element(*node, part)) : node->find(part);
  }
  if (node) std::erase_if(node->children, [&](const Node& child) { return child.key == key; });
}

}  // namespace

CaseTree::CaseTree(const std::string& text, const std::string& name) : name_(name) {
  check_text(text, name);
  std::vector<Problem> problems;
  std::vector<std::string> bases;
  root_ = parse_extended(std::make_shared<Source>(Source{name, text}), problems, bases);
  if (!problems.empty()) throw CaseError(problems);
}

CaseTree CaseTree::load(const std::string& path) {
  const std::string file = case_file(path);
  return {case_tree(file), file};
}

void CaseTree::set(const std::vector<Assignment>& assignments) {
  Node root = root_;
  std::vector<Problem> problems;
  std::vector<std::shared_ptr<const Source>> sources;
  for (const Assignment& a : assignments) {
    if (!a.value) {
      remove(root, a.path);
      continue;
    }
    const std::string key = split_path(a.path).back();
    sources.push_back(std::make_shared<Source>(Source{a.written, key + " = " + *a.value}));
    Node parsed = parse_toml(sources.back(), problems);
    if (parsed.children.size() != 1) continue;
    const Place place = parsed.children.front().place;
    if (auto refusal = put_value(root, a.path, std::move(parsed.children.front()))) {
      refusal->key = a.path;
      refusal->place = place;
      problems.push_back(std::move(*refusal));
    }
  }
  if (problems.empty()) resolve_case(root, name_, problems);
  std::erase_if(problems, [&](const Problem& p) {  // the rest is told when the case is used
    return std::find(sources.begin(), sources.end(), p.place.source) == sources.end();
  });
  if (!problems.empty()) throw CaseError(problems);
  root_ = std::move(root);
}

Case CaseTree::checked(std::vector<Problem>* warnings, std::optional<Scene>* scene) const {
  std::vector<Problem> problems;
  Case c = resolve_case(
      root_, name_, problems, [scene](const Case& of) { return check_set_up(of, scene); }, warnings);
  if (!problems.empty()) throw CaseError(problems);
  return c;
}

Case CaseTree::as_it_stands() const {
  std::vector<Problem> problems;
  return resolve_case(root_, name_, problems);
}

}  // namespace ejecta::python
