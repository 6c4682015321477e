#pragma once
#include <nlohmann/json_fwd.hpp>

#include "case/case.hpp"
#include "simulation/scene.hpp"

namespace ejecta {

/// What a case looks like from the side, in the plane of the path: x, z in m. box (corners of the computed
/// one), nozzle, plate (its edge), bodies (name, outline of their box, undisturbed path); what is not there
/// is left out.
nlohmann::ordered_json drawing_of(const Case& c, const Scene& scene);

}  // namespace ejecta
