#pragma once
#include <vector>

#include "case/case.hpp"
#include "case/problem.hpp"

namespace ejecta {

/// What can be told from the case alone to be impossible (errors) or unlikely to be meant (warnings).
std::vector<Problem> check_sense(const Case&);

}  // namespace ejecta
