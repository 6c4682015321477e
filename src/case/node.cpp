#include "case/node.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace ejecta {

std::string_view Place::text() const {
  return source ? std::string_view(source->text).substr(std::min(offset, source->text.size()), length)
                : std::string_view();
}

int Place::line_number() const {
  const auto end = source->text.begin() + static_cast<std::ptrdiff_t>(std::min(offset, source->text.size()));
  return 1 + static_cast<int>(std::count(source->text.begin(), end, '\n'));
}

std::size_t Place::column() const {
  const std::string_view before = std::string_view(source->text).substr(0, offset);
  return before.size() - (before.rfind('\n') + 1);  // without a line end that is 0
}

std::string_view Place::line() const {
  const std::size_t start = std::min(offset, source->text.size()) - column();
  std::string_view rest = std::string_view(source->text).substr(start);
  rest = rest.substr(0, rest.find('\n'));
  if (rest.ends_with('\r')) rest.remove_suffix(1);
  return rest;
}

const Node* Node::find(std::string_view name) const {
  const auto it =
      std::find_if(children.begin(), children.end(), [&](const Node& n) { return n.key == name; });
  return it == children.end() ? nullptr : &*it;
}

Node* Node::find(std::string_view name) { return const_cast<Node*>(std::as_const(*this).find(name)); }

std::string kind_words(const Node& n) {
  struct Words {
    const Node& n;
    std::string operator()(Node::Table) const { return "a table"; }
    std::string operator()(Node::List) const { return fmt::format("a list of {}", n.children.size()); }
    std::string operator()(bool b) const { return b ? "true" : "false"; }
    std::string operator()(std::int64_t i) const { return fmt::format("the bare number {}", i); }
    std::string operator()(double d) const { return fmt::format("the bare number {}", d); }
    std::string operator()(const std::string& s) const {
      return fmt::format("the text \"{}\"", s.substr(0, 60));
    }
  };
  return std::visit(Words{n}, n.value);
}

}  // namespace ejecta
