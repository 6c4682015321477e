#pragma once
#include <memory>
#include <vector>

#include "case/node.hpp"
#include "case/problem.hpp"

namespace ejecta {

/// Parses TOML into a tree. Syntax errors are added to `problems`; the lines they stand on are left out, so
/// that the rest of the file is still looked at.
Node parse_toml(std::shared_ptr<const Source> source, std::vector<Problem>& problems);

}  // namespace ejecta
