#pragma once
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/vec.hpp"
#include "case/node.hpp"

namespace ejecta {

enum class Severity { error, warning };

/// Something wrong with a case, with all that helps to mend it. Empty parts are not shown.
struct Problem {
  std::string key{};       ///< e.g. "body.0.diameter"
  std::string what{};      ///< what is wrong
  std::string expected{};  ///< what would be right
  std::string nearest{};   ///< the known key or word most like what was written
  std::string example{};   ///< a line that works
  Severity severity = Severity::error;
  Place place{};  ///< without source: shown without line and caret
};

/// What is wrong with a case, problem by problem; its words are render() of them.
struct CaseError : InputError {
  explicit CaseError(std::vector<Problem> list);
  std::vector<Problem> problems;
};

/// Of any refusal: that of a case problem by problem, another as one.
std::vector<Problem> problems_of(const InputError& refusal);

/// So many that nobody reads one more.
inline bool enough(const std::vector<Problem>& problems) { return problems.size() >= 1000; }

/// For an example: ["10 mm", "0 mm", "5 mm"].
std::string place_text(const Vec3& place);
/// A line for an example: key = ["10 mm", "0 mm", "5 mm"].
std::string place_line(const std::string& key, const Vec3& place);

/// The problem as the user sees it: file, line, key, the line itself with a caret, and the help.
std::string render(const Problem&);
/// The first problems in the order of the file, and how many there are.
std::string render(std::vector<Problem>);

}  // namespace ejecta
