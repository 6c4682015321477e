#pragma once
#include <nlohmann/json.hpp>
#include <vector>

#include "case/case.hpp"
#include "sorter/shot.hpp"

namespace ejecta {

/// The shot as an ordinary run: all its bodies in the box of the case, its valves as orifices of one command.
Case resolved_case(const Case& sorter, const Shot& shot);

/// What the run did to a body of the shot, from its result.json.
struct ResolvedBody {
  bool ejected = false;
  double gain = 0.0;  ///< m/s, of vertical velocity
};
std::vector<ResolvedBody> resolved_bodies(const nlohmann::ordered_json& result);

}  // namespace ejecta
