#pragma once
#include <vector>

#include "base/vec.hpp"
#include "shape/triangle_mesh.hpp"

namespace ejecta {

/// normal . x = offset; `normal` is a unit vector. Lengths in m.
struct Plane {
  Vec3 normal{0, 0, 1};
  double offset = 0.0;
  double height(const Vec3& p) const { return normal.dot(p) - offset; }
};

/// A solid bounded by flat faces of any outline. A face is a bag of directed edges with the solid's face on
/// their left, seen from outside: no loops to follow, no triangles to make, holes need no special care.
struct FacetedSolid {
  struct Edge {
    Vec3 from, to;
  };
  struct Face {
    Plane plane;  ///< outward
    std::vector<Edge> edges;
    bool from_cut = false;  ///< it was inside before
  };
  std::vector<Face> faces;

  double volume() const;  ///< m3, divergence theorem
  /// Corners of all faces, each once.
  std::vector<Vec3> corners() const;
};

FacetedSolid faceted(const TriangleMesh& mesh);

/// The parts of the solid below and above the plane, each closed by a face in it. Corners within `tolerance`
/// (m) of the plane count as on it; faces that lie in it are replaced by those that close the parts, so that
/// cuts along a face are as sound as any other.
struct CutSolid {
  FacetedSolid below, above;
};
CutSolid cut(const FacetedSolid& solid, const Plane& plane, double tolerance);

}  // namespace ejecta
