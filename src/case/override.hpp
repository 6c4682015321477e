#pragma once
#include <optional>
#include <string>
#include <vector>

#include "case/node.hpp"
#include "case/problem.hpp"

namespace ejecta {

/// Puts "body.0.velocity=[...]" into the tree; list elements are addressed by number or by their `name`.
void apply_override(Node& root, const std::string& assignment, std::vector<Problem>& problems);

/// Puts a value at "body.0.velocity"; what is in the way, or nothing.
std::optional<Problem> put_value(Node& root, const std::string& path, Node value);

}  // namespace ejecta
