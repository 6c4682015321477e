#pragma once
#include <array>
#include <span>
#include <vector>

#include "shape/polytope.hpp"
#include "shape/triangle_mesh.hpp"

namespace ejecta {

/// A surface of triangles as bodies meet it: what counts is where it lies, not how it is divided. It touches
/// on the side to which its normals look, an open one on both if so asked. World axes.
class Surface {
 public:
  struct Triangle {
    std::array<Vec3, 3> corners;
    Vec3 normal{0, 0, 1};
    int region = 0;
  };
  /// A convex flat part of a region. `sides`: planes through its edges; they bound what lies behind it (and
  /// before it), halfway to the neighbouring region where the surface turns there.
  struct Piece {
    std::vector<Vec3> corners;
    std::vector<HalfSpace> sides;
    Vec3 centre{0, 0, 0};
    double radius = 0.0;  ///< m, of the ball about the centre that holds it
  };
  /// All triangles that lie in one plane and look the same way.
  struct Region {
    HalfSpace plane;
    std::vector<Piece> pieces;
    /// Whether a point of the plane lies in the region and farther than `margin` from its rim. (Between two
    /// of its pieces it may be said not to.)
    bool holds(const Vec3& point, double margin) const;
  };

  explicit Surface(const TriangleMesh& mesh, bool two_sided = false);

  bool closed() const { return closed_; }
  bool two_sided() const { return two_sided_; }
  std::span<const Triangle> triangles() const { return triangles_; }
  std::span<const Region> regions() const { return regions_; }
  double tolerance() const { return tolerance_; }  ///< m, what the digits of a file may move a corner

  /// visit(n) for all triangles whose bounding boxes meet that of a ball.
  template <class Visit>
  void near(const Vec3& centre, double reach, const Visit& visit) const;
  /// Whether the point lies in the solid that a closed surface bounds.
  bool contains(const Vec3& point) const;

 private:
  void find_regions(const TriangleMesh& mesh);
  void build_tree();
  /// A box that holds triangles order_[first, first + count), or those of the two nodes `child`, child + 1.
  struct Node {
    Vec3 low, high;
    int child = 0, first = 0, count = 0;
  };
  std::vector<Triangle> triangles_;
  std::vector<Region> regions_;
  std::vector<Node> nodes_;
  std::vector<int> order_;
  double tolerance_ = 0.0;
  bool closed_ = false, two_sided_ = false;
};

template <class Visit>
void Surface::near(const Vec3& centre, double reach, const Visit& visit) const {
  int stack[64] = {0}, size = 1;
  while (size > 0) {
    const Node& node = nodes_[static_cast<std::size_t>(stack[--size])];
    if (((node.low - centre).array() > reach).any() || ((centre - node.high).array() > reach).any()) continue;
    for (int n = node.first; n < node.first + node.count; ++n) visit(order_[static_cast<std::size_t>(n)]);
    if (node.count == 0) {
      stack[size++] = node.child + 1;
      stack[size++] = node.child;
    }
  }
}

}  // namespace ejecta
