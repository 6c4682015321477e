#pragma once
#include <vector>

#include "case/node.hpp"
#include "case/problem.hpp"

namespace ejecta {

/// Adds a problem for every key and section that the schema does not have, with the nearest one it has.
void refuse_unknown_keys(const Node& root, std::vector<Problem>& problems);

}  // namespace ejecta
