#include "shape/triangle_mesh.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <utility>

#include "base/error.hpp"
#include "shape/mass_properties.hpp"

namespace ejecta {
namespace {

std::string text(const Vec3& p) { return fmt::format("({:.6g}, {:.6g}, {:.6g}) m", p.x(), p.y(), p.z()); }

}  // namespace

void require_closed(const TriangleMesh& mesh, const std::string& name) {
  if (mesh.triangles.size() < 4)
    throw InputError(fmt::format("{}: {} triangles cannot enclose a solid (at least 4 are needed)", name,
                                 mesh.triangles.size()));
  const auto at = [&](int v) -> const Vec3& { return mesh.vertices[static_cast<std::size_t>(v)]; };
  std::map<std::pair<int, int>, int> edges;  // directed edge -> triangle
  for (std::size_t n = 0; n < mesh.triangles.size(); ++n) {
    const auto& t = mesh.triangles[n];
    const Vec3 a = at(t[1]) - at(t[0]), b = at(t[2]) - at(t[0]);
    const double longest = std::max({a.norm(), b.norm(), (a - b).norm()});
    if (!(a.cross(b).norm() > 1e-12 * longest * longest))
      throw InputError(
          fmt::format("{}: triangle {} is degenerate (no area): corners {}, {}, {}; remove it or "
                      "merge its vertices",
                      name, n + 1, text(at(t[0])), text(at(t[1])), text(at(t[2]))));
    for (std::size_t c = 0; c < 3; ++c) {
      const std::pair edge{t[c], t[(c + 1) % 3]};
      const auto [other, fresh] = edges.emplace(edge, static_cast<int>(n));
      if (!fresh)
        throw InputError(
            fmt::format("{}: triangles {} and {} run the same way along the edge {} - {}: one of "
                        "them is inside out, or more than two meet there",
                        name, other->second + 1, n + 1, text(at(edge.first)), text(at(edge.second))));
    }
  }
  for (const auto& [edge, triangle] : edges)
    if (!edges.contains({edge.second, edge.first}))
      throw InputError(fmt::format("{}: the mesh is open: the edge {} - {} of triangle {} has no neighbour",
                                   name, text(at(edge.first)), text(at(edge.second)), triangle + 1));
  const double volume = mass_mesh(mesh).volume;
  if (!(volume > 0))
    throw InputError(
        fmt::format("{}: the mesh is inside out (volume {:.6g} m3): its normals point inwards; "
                    "reverse the order of the corners of every triangle",
                    name, volume));
}

TriangleMesh icosphere(int levels) {
  const double g = 0.5 * (1.0 + std::sqrt(5.0));
  TriangleMesh mesh;
  for (const Vec3& v :
       {Vec3(-1, g, 0), Vec3(1, g, 0), Vec3(-1, -g, 0), Vec3(1, -g, 0), Vec3(0, -1, g), Vec3(0, 1, g),
        Vec3(0, -1, -g), Vec3(0, 1, -g), Vec3(g, 0, -1), Vec3(g, 0, 1), Vec3(-g, 0, -1), Vec3(-g, 0, 1)})
    mesh.vertices.push_back(v.normalized());
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [at, fresh] = middles.emplace(std::minmax(a, b), static_cast<int>(mesh.vertices.size()));
      if (fresh)
        mesh.vertices.push_back(
            (mesh.vertices[static_cast<std::size_t>(a)] + mesh.vertices[static_cast<std::size_t>(b)])
                .normalized());
      return at->second;
    };
    std::vector<std::array<int, 3>> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
  }
  return mesh;
}

}  // namespace ejecta
