#pragma once
#include "flow/model/flow_model.hpp"

namespace ejecta {

/// Compressible flow of a case: shock tubes, waves, jets from their orifice, boxes with bodies.
std::unique_ptr<FlowModel> make_compressible_model(const Case& c, const Grid& grid, Inflow inflow);

}  // namespace ejecta
