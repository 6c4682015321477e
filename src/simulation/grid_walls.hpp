#pragma once
#include <vector>

#include "case/case.hpp"
#include "dem/particles.hpp"
#include "grid/grid.hpp"

namespace ejecta {

/// The faces of the grid on which fluid sticks ("wall", "moving-wall"), as bodies meet them: slabs as large
/// as the face, of the first body's material, since beside the box bodies fly where they like. Through all
/// other faces bodies leave. A [[wall]] whose surface lies in the face stands for it, with its own material
/// and speed.
std::vector<Wall> grid_walls(const Case& c, const Grid& grid, const Particles& particles);

}  // namespace ejecta
