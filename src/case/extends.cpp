#include "case/extends.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/error.hpp"
#include "case/case_text.hpp"
#include "case/toml.hpp"

namespace ejecta {
namespace {

constexpr const char* kExtends = "extends";
constexpr int kMostBases = 16;  ///< one behind the other: more is a circle or a mistake

Problem wrong(const Node& extends, const std::string& what) {
  return {.key = kExtends,
          .what = what,
          .expected = "the name of another case file, relative to this one",
          .example = "extends = \"base.toml\"",
          .place = extends.place};
}

bool is_list_of_tables(const Node& node) {
  return node.is_list() && !node.children.empty() &&
         std::all_of(node.children.begin(), node.children.end(), [](const Node& n) { return n.is_table(); });
}

/// What tells the elements of a list apart: their name; of an expectation what it is about, of a measurement
/// what it is of.
const std::string* name_of(const Node& element) {
  for (const char* key : {"name", "quantity", "of"})
    if (const Node* name = element.find(key)) return std::get_if<std::string>(&name->value);
  return nullptr;
}

Node* of_same_name(Node& list, const Node& element) {
  const std::string* name = name_of(element);
  for (Node& candidate : list.children)
    if (const std::string* other = name ? name_of(candidate) : nullptr; other && *other == *name)
      return &candidate;
  return nullptr;
}

void lay_over(Node& base, Node over) {
  base.place = over.place;
  for (Node& child : over.children) {
    Node* const old = base.find(child.key);
    if (!old) {
      base.children.push_back(std::move(child));
    } else if (old->is_table() && child.is_table()) {
      lay_over(*old, std::move(child));
    } else if (is_list_of_tables(*old) && is_list_of_tables(child)) {
      for (Node& element : child.children) {
        if (Node* same = of_same_name(*old, element)) lay_over(*same, std::move(element));
        else old->children.push_back(std::move(element));
      }
    } else {
      *old = std::move(child);
    }
  }
}

/// The file that an `extends` names. Null, and a problem, where it cannot be read.
std::shared_ptr<const Source> read_base(const Source& source, const Node& extends,
                                        std::vector<Problem>& problems) {
  const std::string* file = std::get_if<std::string>(&extends.value);
  if (!file) {
    problems.push_back(wrong(extends, kind_words(extends) + " where the name of a file is needed"));
    return nullptr;
  }
  const std::filesystem::path name(*file);
  const std::filesystem::path path = std::filesystem::path(source.name).parent_path() / name;
  std::error_code none;
  try {
    // What is no plain file might never end.
    if (std::filesystem::exists(path, none) && !std::filesystem::is_regular_file(path, none))
      throw InputError(fmt::format("{}: is not a file", path.string()));
    auto base = std::make_shared<Source>(Source{path.string(), read_case_text(path.string())});
    check_text(base->text, base->name);
    const auto folder = std::filesystem::path(source.folder) / name.parent_path();
    base->folder = name.is_absolute() ? name.parent_path().string() : folder.string();
    return base;
  } catch (const InputError& e) {
    const std::string what = e.what();
    problems.push_back(wrong(extends, what.substr(0, what.find('\n'))));
    return nullptr;
  }
}

Node parse(const std::shared_ptr<const Source>& source, std::vector<Problem>& problems,
           std::vector<std::string>& bases, int depth) {
  Node root = parse_toml(source, problems);
  const Node* found = root.find(kExtends);
  if (!found) return root;
  const Node extends = *found;
  std::erase_if(root.children, [](const Node& n) { return n.key == kExtends; });
  if (depth == kMostBases) {
    problems.push_back(
        wrong(extends, fmt::format("more than {} files that extend one another: a circle?", depth)));
    return root;
  }
  const auto base = read_base(*source, extends, problems);
  if (!base) return root;
  bases.push_back(base->name);
  Node whole = parse(base, problems, bases, depth + 1);
  lay_over(whole, std::move(root));
  return whole;
}

}  // namespace

Node parse_extended(const std::shared_ptr<const Source>& source, std::vector<Problem>& problems,
                    std::vector<std::string>& bases) {
  return parse(source, problems, bases, 0);
}

}  // namespace ejecta
