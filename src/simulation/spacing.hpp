#pragma once
#include <nlohmann/json.hpp>

#include "dem/particles.hpp"

namespace ejecta {

/// Distance of a body to the nearest other one.
struct Spacing {
  int body = 0, neighbour = -1;
  double gap = 0.0;     ///< m, between the surfaces
  double centre = 0.0;  ///< m, between the centres of mass
};

/// Of every body that is there, if there are two; across periodic sides as well. The gap is that of corners
/// (and of points spread over curved surfaces) from the other body, so exact but for two crossing edges.
std::vector<Spacing> spacings(const Particles& particles);

/// Whether there is a wall that moves.
bool belt_runs(const Particles& particles);

/// What a sorter's belt carries: where a wall moves, result["spacing"] has mean, least and median gap between
/// neighbours and the largest speed of a body relative to the wall it lies on.
void add_spacing(const Particles& particles, nlohmann::ordered_json& result);

}  // namespace ejecta
