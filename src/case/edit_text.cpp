#include "case/edit_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "case/node_path.hpp"
#include "case/problem.hpp"
#include "case/toml.hpp"

namespace ejecta {
namespace {

bool is_header(const Node& n) { return n.is_table() && n.place.text().starts_with('['); }

std::size_t end_of(const Place& p) { return p.offset + p.length; }

/// Behind the newline of the line on which `at` lies.
std::size_t next_line(const std::string& text, std::size_t at) {
  const std::size_t end = text.find('\n', at);
  return end == std::string::npos ? text.size() : end + 1;
}

std::size_t start_of_line(const std::string& text, std::size_t at) {
  const std::size_t before = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
  return before == std::string::npos ? 0 : before + 1;
}

/// A text as a tree, with the ways through it that an editor needs.
class EditedText {
 public:
  explicit EditedText(const std::string& text) : text_(text) {
    std::vector<Problem> problems;
    root_ = parse_toml(std::make_shared<Source>(Source{"the case", text}), problems);
    if (!problems.empty()) throw CaseError(problems);
  }

  const Node* find(const std::string& path) const { return find_node(root_, path); }

  /// Where a new key of that section goes, or npos where the section has no header of its own.
  std::size_t end_of_section(const std::string& section) const {
    const Node* node = find(section);
    if (!node || !is_header(*node) || !has_header(*node, section)) return std::string::npos;
    std::size_t last = end_of(node->place);
    for (const Node& child : node->children)
      if (!holds_header(child) && child.place.offset > node->place.offset)
        last = std::max(last, end_of(child.place));
    return next_line(text_, last);
  }

  /// The line "# key = value" in a section: its start, or npos.
  std::size_t commented(const std::string& section, const std::string& key) const {
    const Node* node = find(section);
    if (!node || !is_header(*node) || !has_header(*node, section)) return std::string::npos;
    std::size_t next = text_.size();
    for_each_header(root_, [&](const Node& n) {
      if (n.place.offset > node->place.offset) next = std::min(next, n.place.offset);
    });
    for (std::size_t at = next_line(text_, node->place.offset); at < next; at = next_line(text_, at)) {
      std::size_t letter = text_.find_first_not_of(" \t", at);
      if (letter == std::string::npos || text_[letter] != '#') continue;
      letter = text_.find_first_not_of(" \t#", letter);
      if (letter == std::string::npos || text_.compare(letter, key.size(), key) != 0) continue;
      const std::size_t equals = text_.find_first_not_of(" \t", letter + key.size());
      if (equals != std::string::npos && text_[equals] == '=') return at;
    }
    return std::string::npos;
  }

 private:
  /// A table that is there only because of [section.below] has the header of that one.
  bool has_header(const Node& node, const std::string& section) const {
    std::string header, words;
    for (const char c : node.place.text())
      if (c != ' ' && c != '[' && c != ']') header += c;
    const Node* above = &root_;
    for (const std::string& part : split_path(section))
      if (above->is_list()) {
        above = element(*above, part);
      } else {
        words += (words.empty() ? "" : ".") + part;
        above = above->find(part);
      }
    return header == words;
  }
  static bool holds_header(const Node& node) {
    return is_header(node) || (node.is_list() && node.is_header_list);
  }
  template <class Visit>
  static void for_each_header(const Node& node, const Visit& visit) {
    if (is_header(node)) visit(node);
    for (const Node& child : node.children) for_each_header(child, visit);
  }

  const std::string& text_;
  Node root_;
};

/// "body.0" -> "[[body]]", "grid.x" -> "[grid.x]". A list grows by the element behind its last one: another
/// number would not be that of the new element.
std::string new_header(const EditedText& edited, const std::string& section) {
  const std::size_t dot = section.rfind('.');
  if (dot == std::string::npos) return fmt::format("[{}]", section);
  const std::string list = section.substr(0, dot);
  const Node* before = edited.find(list);
  const bool is_number = section.find_first_not_of("0123456789", dot + 1) == std::string::npos;
  if (!is_number && !(before && before->is_list())) return fmt::format("[{}]", section);
  const std::string next = fmt::format("{}.{}", list, before ? before->children.size() : 0);
  if (section != next)
    throw InputError(fmt::format("there is no {}\n  expected: {}, the next one", section, next));
  return fmt::format("[[{}]]", list);
}

}  // namespace

std::string with_key(const std::string& text, const std::string& path, const std::string& value) {
  const EditedText edited(text);
  if (const Node* old = edited.find(path)) {
    if (is_header(*old)) throw InputError(fmt::format("\"{}\" is a section, no key", path));
    return text.substr(0, old->place.offset) + value + text.substr(end_of(old->place));
  }
  const std::size_t dot = path.rfind('.');
  if (dot == std::string::npos) throw InputError(fmt::format("\"{}\" names no section", path));
  const std::string section = path.substr(0, dot), line = path.substr(dot + 1) + " = " + value + "\n";
  if (const std::size_t at = edited.commented(section, path.substr(dot + 1)); at != std::string::npos)
    return text.substr(0, at) + line + text.substr(next_line(text, at));
  if (const Node* inside = edited.find(section); inside && !inside->is_list() && !is_header(*inside))
    throw InputError(fmt::format("{} stands in braces; change it in the text", section));
  std::size_t at = edited.end_of_section(section);
  const std::string break_before = !text.empty() && !text.ends_with('\n') ? "\n" : "";
  if (at == std::string::npos)
    return text + break_before + (text.empty() ? "" : "\n") + new_header(edited, section) + "\n" + line;
  return text.substr(0, at) + (at == text.size() ? break_before : "") + line + text.substr(at);
}

std::string without_key(const std::string& text, const std::string& path) {
  const EditedText edited(text);
  const Node* old = edited.find(path);
  if (!old) return text;
  if (is_header(*old)) throw InputError(fmt::format("\"{}\" is a section, no key", path));
  return text.substr(0, start_of_line(text, old->place.offset)) +
         text.substr(next_line(text, end_of(old->place)));
}

}  // namespace ejecta
