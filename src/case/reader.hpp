#pragma once
#include <string>
#include <vector>

#include "case/case.hpp"
#include "case/node.hpp"
#include "case/problem.hpp"

namespace ejecta {

/// Reads the tree into `c` through the schema; whatever does not fit is added to `problems`.
void read_case(const Node& root, Case& c, std::vector<Problem>& problems);

/// Puts "body.0.velocity=[...]" into the tree; list elements are addressed by number or by their `name`.
void apply_override(Node& root, const std::string& assignment, std::vector<Problem>& problems);

/// Where a key stands: the deepest part of the dotted path that the tree has.
Place locate(const Node& root, const std::string& path);

}  // namespace ejecta
