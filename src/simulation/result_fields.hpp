#pragma once
#include <optional>

#include "simulation/model.hpp"
#include "simulation/run.hpp"

namespace ejecta {

/// The fields of a model as they are now; nothing where it has none.
std::optional<ResultFields> copied_fields(Model& model);

}  // namespace ejecta
