#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace ejecta {

/// A text that was read, kept for error messages.
struct Source {
  std::string name;  ///< path, or e.g. "--set run.end_time=1"
  std::string text;
  std::string folder{};  ///< where files that it names lie, as seen from the folder of the case; empty: there
};

/// A stretch of a source.
struct Place {
  std::shared_ptr<const Source> source;
  std::size_t offset = 0, length = 0;

  std::string_view text() const;
  int line_number() const;        ///< from 1
  std::string_view line() const;  ///< the whole line, without its end
  std::size_t column() const;     ///< from 0
};

/// A value of the case file with the place where it stands. Nothing of the TOML library shows outside
/// toml.cpp.
struct Node {
  struct Table {};
  struct List {};
  std::string key;  ///< in its table
  std::variant<Table, List, bool, std::int64_t, double, std::string> value;
  std::vector<Node> children;   ///< of a table (in the order of the file) or list
  Place place;                  ///< of the value
  bool is_header_list = false;  ///< [[key]] rather than key = [...]

  bool is_table() const { return std::holds_alternative<Table>(value); }
  bool is_list() const { return std::holds_alternative<List>(value); }
  const Node* find(std::string_view name) const;
  Node* find(std::string_view name);
};

/// What a value is, in words, e.g. "a text", "a list of 3".
std::string kind_words(const Node&);

}  // namespace ejecta
