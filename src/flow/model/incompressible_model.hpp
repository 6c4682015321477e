#pragma once
#include "flow/model/flow_model.hpp"

namespace ejecta {

std::unique_ptr<FlowModel> make_incompressible_model(const Case& c, const Grid& grid, Inflow inflow);

}  // namespace ejecta
