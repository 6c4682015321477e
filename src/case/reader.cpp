#include "case/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "case/node_path.hpp"
#include "case/read_value.hpp"
#include "case/schema.hpp"
#include "case/unknown_keys.hpp"

namespace ejecta {
namespace {

class CaseReader {
 public:
  CaseReader(Case& c, std::vector<Problem>& problems) : case_(c), problems_(problems) {}

  void read(const Node& root) {
    for (const Section& s : sections(case_)) {
      if (s.name == "fluid") ambient_ = case_.environment.pressure;  // [environment] has been read
      read_section(s, find_section(root, s.name), root);
    }
  }

 private:
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
      if (const Node* node = table.find(key.name)) {
        case_.given.insert(path + "." + key.name);
        read_value(*node, key, path + "." + key.name, ambient_, problems_);
      }
    require(keys, &table, path, table.place);
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

  Case& case_;
  std::vector<Problem>& problems_;
  double ambient_ = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace

void read_case(const Node& root, Case& c, std::vector<Problem>& problems) {
  CaseReader(c, problems).read(root);
  refuse_unknown_keys(root, problems);
}

}  // namespace ejecta
