#pragma once
#include <vector>

#include "case/case.hpp"
#include "case/node.hpp"
#include "case/problem.hpp"

namespace ejecta {

/// Reads the tree into `c` through the schema; whatever does not fit is added to `problems`.
void read_case(const Node& root, Case& c, std::vector<Problem>& problems);

}  // namespace ejecta
