#pragma once
#include <optional>
#include <vector>

#include "case/case.hpp"
#include "dem/particles.hpp"
#include "grid/grid.hpp"
#include "sorter/launch.hpp"
#include "sorter/splitter.hpp"

namespace ejecta {

/// Who is there when a run starts: bodies in their places, walls of the case and of the grid, the plate.
/// `check` and `run` set it up with this function, so that what one refuses the other refuses.
struct Scene {
  Particles particles;
  std::vector<FlightState> starts;  ///< of each body
  std::optional<Splitter> splitter;
  std::size_t bodies = 0;  ///< of the particles, that are no grains: they come first
};

/// `c` with its copies written out; `grid` of a case with a flow, else null. Throws InputError for what
/// cannot be built and for bodies that start in each other or in a wall.
Scene make_scene(const Case& c, const Grid* grid);
/// Of a case as it was read: its first copies, in its grid.
Scene scene_of(const Case& c);

}  // namespace ejecta
