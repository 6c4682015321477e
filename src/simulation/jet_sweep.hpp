#pragma once
#include <nlohmann/json.hpp>
#include <optional>

#include "simulation/run.hpp"

namespace ejecta {

/// `ejecta jet CASE --sweep`: settled compressible jets of jet.sweep_pressures and incompressible ones of
/// jet.sweep_velocities, and for every pressure the velocity at which the incompressible jet carries the same
/// momentum, and reads the same total pressure, at the stand-off: result.json. Nothing where it was stopped:
/// no file is written before the end. Throws InputError where the case asks for no jets.
std::optional<nlohmann::ordered_json> sweep_jet(const Case& c, const Context& context);

}  // namespace ejecta
