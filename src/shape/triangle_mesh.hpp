#pragma once
#include <array>
#include <string>
#include <vector>

#include "base/vec.hpp"

namespace ejecta {

/// A surface of triangles, corners counter-clockwise seen from outside. Lengths in m.
struct TriangleMesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<int, 3>> triangles;
};

/// Throws InputError naming `name` and the offending edge or triangle unless the mesh bounds a solid: no
/// degenerate triangle, every edge shared by exactly two triangles that run along it in opposite directions,
/// outward normals (positive volume).
void require_closed(const TriangleMesh& mesh, const std::string& name);

/// Throws InputError naming two triangles that go through each other.
void require_not_crossing(const TriangleMesh& mesh, const std::string& name);

/// Unit sphere: an icosahedron divided `levels` times, 20 * 4^levels triangles.
TriangleMesh icosphere(int levels);

}  // namespace ejecta
