#pragma once
#include <cstdint>

#include "case/case.hpp"
#include "grid/grid.hpp"
#include "simulation/prospect.hpp"

/// What the air of a case will do, told without computing it.
namespace ejecta {

/// Highest speed on the axis where the jet enters the box, m/s.
double jet_speed(const Case& c);

/// Until when the air is computed, s. A run that waits for its verdict stops it (CoupledModel::watch_air)
/// when no body is in the box any more, or when it has died away.
double air_until(const Case& c, const Company& company);

/// Steps of the air until then, where a jet and the Courant number set them.
std::int64_t jet_steps(const Case& c, const Grid& grid, double until);

}  // namespace ejecta
