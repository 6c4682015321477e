#pragma once
#include <array>
#include <string>
#include <vector>

#include "case/case.hpp"
#include "dem/materials.hpp"
#include "shape/polytope.hpp"

namespace ejecta {

/// A triangle of a wall's mesh as balls meet it. Of an edge or corner that triangles share, only one of them
/// owns the contact, and none where the surface is flat or hollow: there the faces meet the ball first.
struct Facet {
  std::array<Vec3, 3> corners;
  std::array<bool, 7> owns{true, false, false, false, false, false, false};  ///< by TriangleFeature
  Vec3 normal{0, 0, 1};
  double thickness = 0.0;  ///< m, how deep behind the face a ball is still pushed out
};

/// Something that never moves but may drag what lies on it: a half-space or convex solids. World axes.
struct Wall {
  std::string name;
  int material = 0;
  Vec3 velocity{0, 0, 0};  ///< m/s, of its surface (belt)
  bool is_plane = true;
  Vec3 normal{0, 0, 1};  ///< plane: unit, towards the bodies
  double offset = 0.0;   ///< plane: normal . x = offset on it
  std::vector<Polytope> solids;
  std::vector<Facet> facets;  ///< of a mesh: one for each solid
};

/// The triangles of an open or closed surface, with the edges and corners that each owns.
std::vector<Facet> make_facets(const TriangleMesh& mesh, double thickness);

/// A [[wall]] entry. Throws InputError naming the wall.
Wall make_wall(const WallSpec& spec, const Materials& materials, const std::string& directory);

}  // namespace ejecta
