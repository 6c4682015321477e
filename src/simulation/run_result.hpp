#pragma once
#include <nlohmann/json.hpp>
#include <span>

#include "simulation/coupled_model.hpp"

namespace ejecta {

/// result.json of a run as it stands (docs/files.md). `operators`: those of the step and what else took time.
nlohmann::ordered_json make_result(const CoupledModel& model, double time, std::int64_t steps,
                                   double wall_time, std::span<const OperatorTime> operators);

}  // namespace ejecta
