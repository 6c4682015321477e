#pragma once
#include <string>
#include <vector>

#include "case/case.hpp"
#include "dem/materials.hpp"
#include "shape/polytope.hpp"

namespace ejecta {

/// Something that never moves but may drag what lies on it: a half-space or convex solids. World axes.
struct Wall {
  std::string name;
  int material = 0;
  Vec3 velocity{0, 0, 0};  ///< m/s, of its surface (belt)
  bool is_plane = true;
  Vec3 normal{0, 0, 1};  ///< plane: unit, towards the bodies
  double offset = 0.0;   ///< plane: normal . x = offset on it
  std::vector<Polytope> solids;
};

/// A [[wall]] entry. Throws InputError naming the wall.
Wall make_wall(const WallSpec& spec, const Materials& materials, const std::string& directory);
/// The dividing plate: its upper front edge at `edge`, reaching `length` downstream (+x) and `width` across.
Wall make_plate_wall(const Vec3& edge, double length, double width, double thickness, int material);

}  // namespace ejecta
