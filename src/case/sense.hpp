#pragma once
#include <set>
#include <string>
#include <vector>

#include "case/case.hpp"
#include "case/problem.hpp"

namespace ejecta {

/// What can be told from the case alone to be impossible (errors) or unlikely to be meant (warnings). What
/// rests on a section in `unsound` (one that could not be read, e.g. "grid") is not looked at.
std::vector<Problem> check_sense(const Case&, std::set<std::string> unsound = {});

/// "body" of "body.0.diameter".
std::string section_of(const std::string& key);

}  // namespace ejecta
