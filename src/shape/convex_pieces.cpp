#include <algorithm>
#include <numeric>

#include "shape/convex_parts.hpp"
#include "shape/point_order.hpp"

namespace ejecta {
namespace {

constexpr double kShallow = 1e-6;  // of the size: less is no hollow

/// Vertices of each piece of the mesh that hangs together.
std::vector<std::vector<int>> pieces_of(const TriangleMesh& mesh) {
  std::vector<int> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto top = [&](int v) {
    while (parent[static_cast<std::size_t>(v)] != v) v = parent[static_cast<std::size_t>(v)];
    return v;
  };
  for (const auto& t : mesh.triangles)
    for (const int c : {t[1], t[2]}) {
      const int a = top(t[0]), b = top(c);
      parent[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
    }
  std::vector<std::vector<int>> pieces(mesh.vertices.size());
  for (const auto& t : mesh.triangles)
    for (const int c : t) pieces[static_cast<std::size_t>(top(c))].push_back(c);
  std::erase_if(pieces, [](const auto& p) { return p.empty(); });
  for (auto& p : pieces) {
    std::sort(p.begin(), p.end());
    p.erase(std::unique(p.begin(), p.end()), p.end());
  }
  return pieces;
}

/// Whether all points lie on the hull, but for hollows too shallow to count.
bool fills(const std::vector<Vec3>& points, const Polytope& hull) {
  std::vector<Vec3> corners = hull.vertices;
  std::sort(corners.begin(), corners.end(), before);
  return std::all_of(points.begin(), points.end(), [&](const Vec3& p) {
    return std::binary_search(corners.begin(), corners.end(), p, before) ||
           -nearest_on_polytope(hull, p).distance <= kShallow * hull.radius;
  });
}

}  // namespace

std::vector<Polytope> convex_pieces(const TriangleMesh& mesh) {
  std::vector<Polytope> hulls;
  for (const auto& piece : pieces_of(mesh)) {
    std::vector<Vec3> points;
    for (const int v : piece) points.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
    hulls.push_back(convex_hull(points));
    if (!fills(points, hulls.back())) return {};
  }
  return hulls;
}

}  // namespace ejecta
