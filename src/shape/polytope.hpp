#pragma once
#include <memory>
#include <span>
#include <vector>

#include "base/vec.hpp"
#include "shape/superquadric.hpp"
#include "shape/triangle_mesh.hpp"

namespace ejecta {

struct HalfSpace {
  Vec3 normal{0, 0, 1};  ///< unit, outward
  double offset = 0.0;   ///< m, normal . x < offset inside
};

/// A convex solid bounded by flat faces. Lengths in m.
struct Polytope {
  struct Face {
    Vec3 normal;               ///< unit, outward
    double offset = 0.0;       ///< normal . x <= offset inside
    int first = 0, count = 0;  ///< its corners, counter-clockwise, in `corners`
  };
  std::vector<Vec3> vertices;
  std::vector<Face> faces;
  std::vector<Face> seams;    ///< the parts of its faces behind which another part of the same solid, or
                              ///< another wall, goes on
  std::vector<int> corners;   ///< indices of vertices, face after face; seams last
  Vec3 centre{0, 0, 0};       ///< of mass, so inside it: of a sphere that holds it
  double radius = 0.0;        ///< of that sphere
  double largest_face = 0.0;  ///< m2
  /// The smooth solid, in the same axes, that it is inscribed in and stands for; `excess` times as large
  /// about the origin it would hold that solid.
  std::shared_ptr<const Superquadric> exact;
  double excess = 1.0;
};

/// Indices of the vertices of a face, counter-clockwise.
inline std::span<const int> corners_of(const Polytope& p, const Polytope::Face& f) {
  return std::span(p.corners).subspan(static_cast<std::size_t>(f.first), static_cast<std::size_t>(f.count));
}

/// Convex hull of the points; coplanar triangles become one face. Throws InputError where the points have no
/// volume.
Polytope convex_hull(const std::vector<Vec3>& points);
Polytope polytope_box(const Vec3& half);
/// The polytope moved to other axes: p -> rotation * p + translation.
Polytope moved(const Polytope& p, const Mat3& rotation, const Vec3& translation);
/// What of p lies outside q, as convex parts without seams; all of p, as it is, where they only touch.
std::vector<Polytope> without(const Polytope& p, const Polytope& q);
/// Notes where p lies on q, with which it shares no space.
void find_seams(Polytope& p, const Polytope& q);
/// The same of all convex parts of one solid.
void find_seams(std::vector<Polytope>& parts);
/// Fan triangles of its faces.
TriangleMesh triangles_of(const Polytope& p);

enum class TriangleFeature { face, edge_ab, edge_bc, edge_ca, corner_a, corner_b, corner_c };
struct TrianglePoint {
  Vec3 point{0, 0, 0};
  TriangleFeature feature = TriangleFeature::face;  ///< where on the triangle it lies
};
/// The point of a closed triangle nearest to p (Ericson 2005, Real-Time Collision Detection, 5.1.5).
TrianglePoint nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

struct NearestPoint {
  double distance = 0.0;  ///< signed, m
  Vec3 normal{0, 0, 1};   ///< unit, outward
  int face = 0;           ///< whose plane the point lies farthest before (or least behind)
};
/// Exact signed distance of a point and its gradient.
NearestPoint nearest_on_polytope(const Polytope& p, const Vec3& point);
Vec3 support_polytope(const Polytope& p, const Vec3& direction);
/// Of the smooth solid that it stands for, if it does.
Vec3 support_exact(const Polytope& p, const Vec3& direction);
double volume_polytope(const Polytope& p);                 ///< m3
double volume_polytopes(std::span<const Polytope> parts);  ///< m3; space that two share counts twice
/// Smallest distance between two parallel planes that hold the polytope, one of them on a face.
double width_polytope(const Polytope& p);
/// Of the largest part: smaller ones are no feature of the solid.
inline constexpr double kCrumb = 0.05;
/// Width of the thinnest part that is no crumb; infinite of none. m
double width_polytopes(std::span<const Polytope> parts);

}  // namespace ejecta
