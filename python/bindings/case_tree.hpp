#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bindings.hpp"
#include "case/case.hpp"
#include "case/node.hpp"
#include "case/problem.hpp"
#include "simulation/scene.hpp"

namespace ejecta::python {

/// A case as Python holds it: the tree of its file with what was set since, resolved anew when it is asked
/// for.
class CaseTree {
 public:
  CaseTree(const std::string& text, const std::string& name);
  static CaseTree load(const std::string& path);

  /// Sets keys, each given as TOML ("valve.duration", "\"8 ms\"") with what the user wrote, for messages;
  /// without a value: back to its default. All or none: throws CaseError with what is wrong with the values.
  struct Assignment {
    std::string path;
    std::optional<std::string> value;
    std::string written;
  };
  void set(const std::vector<Assignment>& assignments);

  /// With all that a run would check; throws CaseError.
  Case checked(std::vector<Problem>* warnings = nullptr, std::optional<Scene>* scene = nullptr) const;
  /// As far as it can be read.
  Case as_it_stands() const;

  const std::string& name() const { return name_; }
  const Node& root() const { return root_; }

 private:
  CaseTree(Node root, std::string name) : root_(std::move(root)), name_(std::move(name)) {}
  Node root_;
  std::string name_;
};

}  // namespace ejecta::python
