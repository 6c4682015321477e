#pragma once
#include <string>
#include <vector>

#include "case/key.hpp"
#include "case/node.hpp"
#include "case/problem.hpp"

namespace ejecta {

/// Reads one value into the slot of its key, or adds what is wrong with it. `ambient` (Pa, absolute) relates
/// gauge and absolute pressure; NaN while it is not known yet.
void read_value(const Node& node, const Key& key, const std::string& path, double ambient,
                std::vector<Problem>& problems);

}  // namespace ejecta
