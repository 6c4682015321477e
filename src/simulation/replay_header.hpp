#pragma once
#include "output/report_data.hpp"
#include "simulation/coupled_model.hpp"

namespace ejecta {

/// A frame has six bytes a grain; so many tell how the cloud moves.
inline constexpr std::size_t kGrainsShown = 1000;

/// What a replay of the case shows besides its frames: box, slices, bodies, plate, nozzle, the undisturbed
/// path.
output::ReplayHeader replay_header(const Case& c, const CoupledModel& model);

}  // namespace ejecta
