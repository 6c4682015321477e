#pragma once
#include <nlohmann/json.hpp>

#include "app/coupled_model.hpp"

namespace ejecta {

/// result.json of a run as it stands (docs/files.md).
nlohmann::ordered_json make_result(const CoupledModel& model, double time, std::int64_t steps,
                                   double wall_time);

/// What the run takes for granted that the user should know.
std::vector<output::Assumption> assumptions_of(const Case& c);

}  // namespace ejecta
