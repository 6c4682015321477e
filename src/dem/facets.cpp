#include <algorithm>
#include <map>
#include <utility>

#include "dem/walls.hpp"

namespace ejecta {
namespace {

constexpr double kFlat = 1e-6;  // sine of an angle below which two triangles lie in one plane

}  // namespace

std::vector<Facet> make_facets(const TriangleMesh& mesh, double thickness) {
  const auto at = [&](int v) -> const Vec3& { return mesh.vertices[static_cast<std::size_t>(v)]; };
  std::vector<Facet> facets;
  std::map<std::pair<int, int>, std::vector<std::pair<std::size_t, int>>>
      edges;  // -> triangle, its third corner
  for (std::size_t n = 0; n < mesh.triangles.size(); ++n) {
    const auto& t = mesh.triangles[n];
    Facet f{{at(t[0]), at(t[1]), at(t[2])}};
    f.normal = (f.corners[1] - f.corners[0]).cross(f.corners[2] - f.corners[0]).normalized();
    f.thickness = thickness;
    facets.push_back(f);
    for (std::size_t c = 0; c < 3; ++c)
      edges[std::minmax(t[c], t[(c + 1) % 3])].emplace_back(n, t[(c + 2) % 3]);
  }
  // A ridge: every neighbour falls away behind the face. Its first triangle owns it.
  std::vector<bool> sharp(mesh.vertices.size(), true);
  std::vector<std::size_t> owner(mesh.vertices.size(), mesh.triangles.size());
  for (std::size_t n = 0; n < facets.size(); ++n)
    for (std::size_t c = 0; c < 3; ++c) {
      const auto& t = mesh.triangles[n];
      const auto& around = edges.at(std::minmax(t[c], t[(c + 1) % 3]));
      const bool ridge = std::all_of(around.begin(), around.end(), [&](const auto& other) {
        const Vec3 away = at(other.second) - facets[n].corners[c];
        return other.first == n || facets[n].normal.dot(away) < -kFlat * away.norm();
      });
      facets[n].owns[1 + c] = ridge && around.front().first == n;
      if (!ridge)
        sharp[static_cast<std::size_t>(t[c])] = sharp[static_cast<std::size_t>(t[(c + 1) % 3])] = false;
      std::size_t& first = owner[static_cast<std::size_t>(t[c])];
      first = std::min(first, n);
    }
  for (std::size_t n = 0; n < facets.size(); ++n)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t v = static_cast<std::size_t>(mesh.triangles[n][c]);
      facets[n].owns[4 + c] = sharp[v] && owner[v] == n;
    }
  return facets;
}

}  // namespace ejecta
