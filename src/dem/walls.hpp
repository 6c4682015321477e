#pragma once
#include <memory>
#include <string>
#include <vector>

#include "case/case.hpp"
#include "dem/materials.hpp"
#include "dem/surface.hpp"
#include "shape/polytope.hpp"

namespace ejecta {

/// Something that never moves but may drag what lies on it: a half-space or a surface. World axes.
struct Wall {
  std::string name;
  int material = 0;
  Vec3 velocity{0, 0, 0};  ///< m/s, of its surface (belt)
  bool is_plane = true;
  Vec3 normal{0, 0, 1};  ///< plane: unit, towards the bodies
  double offset = 0.0;   ///< plane: normal . x = offset on it
  std::shared_ptr<const Surface> surface;
  int first_plane = 0;           ///< of its WallPlanes: of a surface two a region, its front and its back
  std::vector<Polytope> solids;  ///< what the surface bounds, where that is convex: so polytopes meet it
  bool covered = false;          ///< by other walls: polytopes do not meet it
};

/// A plane as balls meet it: a wall's, or one side of a flat region of its surface.
struct WallPlane {
  Vec3 normal{0, 0, 1};
  double offset = 0.0;
  int wall = 0;
};

/// A [[wall]] entry. Throws InputError naming the wall.
Wall make_wall(const WallSpec& spec, const Materials& materials, const std::string& directory);

}  // namespace ejecta
