#pragma once
#include <nlohmann/json.hpp>
#include <vector>

#include "case/case.hpp"
#include "sorter/shot.hpp"

namespace ejecta {

/// The shot as an ordinary run: all its bodies in the box of the case, its valves as orifices of one command.
Case resolved_case(const Case& sorter, const Shot& shot);

/// Which of its bodies the run ejected, from its result.json.
std::vector<bool> resolved_verdicts(const nlohmann::ordered_json& result);

}  // namespace ejecta
