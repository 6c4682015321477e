#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "base/error.hpp"
#include "shape/polytope_shape.hpp"
#include "shape/principal_axes.hpp"
#include "shape/shape_data.hpp"

namespace ejecta {
namespace {

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

/// The hull of a piece, which must not lie above the piece anywhere.
Polytope convex_piece(const TriangleMesh& mesh, const std::vector<int>& piece, const std::string& name) {
  std::vector<Vec3> points;
  for (const int v : piece) points.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
  const Polytope hull = convex_hull(points);
  for (const int v : piece) {
    const Vec3& p = mesh.vertices[static_cast<std::size_t>(v)];
    const double depth = -nearest_on_polytope(hull, p).distance;
    if (depth > 1e-6 * hull.radius)
      throw InputError(fmt::format(
          "{}: the piece is not convex: its vertex ({:.6g}, {:.6g}, {:.6g}) m lies {:.3g} m below "
          "the convex hull; divide it into closed convex pieces, or use the hull (shape = "
          "\"polyhedron\")",
          name, p.x(), p.y(), p.z(), depth));
  }
  return hull;
}

/// Parts that share space would be counted twice. (That no corner of one lies inside another is not all that
/// could be asked, but what happens.)
void require_disjoint(const std::vector<Polytope>& parts, const std::string& name) {
  for (std::size_t a = 0; a < parts.size(); ++a)
    for (std::size_t b = 0; b < parts.size(); ++b)
      for (const Vec3& v : parts[b].vertices) {
        if (a == b) continue;
        const double depth = -nearest_on_polytope(parts[a], v).distance;
        if (depth > 1e-3 * std::min(parts[a].radius, parts[b].radius))
          throw InputError(fmt::format(
              "{}: convex pieces overlap: a corner of piece {} at ({:.6g}, {:.6g}, {:.6g}) m lies {:.3g} m "
              "inside piece {}; pieces may touch but not share space",
              name, b + 1, v.x(), v.y(), v.z(), depth, a + 1));
      }
}

}  // namespace

Shape make_polytope_shape(std::vector<Polytope> parts, TriangleMesh surface, const MassProperties& mass) {
  auto data = std::make_shared<ShapeData>();
  data->mass = mass;
  data->frame = to_principal_axes(data->mass);
  const Mat3 turn = data->frame.rotation.conjugate().toRotationMatrix();
  for (Polytope& p : parts) p = moved(p, turn, -(turn * data->frame.centre));
  for (Vec3& v : surface.vertices) {
    v = to_body(data->frame, v);
    data->bounding_radius = std::max(data->bounding_radius, v.norm());
  }
  data->smallest_feature = width_polytope(parts.front());
  for (const Polytope& p : parts)
    data->smallest_feature = std::min(data->smallest_feature, width_polytope(p));
  data->geometry = PolytopesGeometry{std::move(parts), std::move(surface)};
  return Shape(data);
}

Shape make_polyhedron(const std::vector<Vec3>& points) {
  Polytope hull = convex_hull(points);
  TriangleMesh surface = triangles_of(hull);
  const MassProperties mass = mass_mesh(surface);
  return make_polytope_shape({std::move(hull)}, std::move(surface), mass);
}

Shape make_mesh(const TriangleMesh& mesh, const std::string& name) {
  require_closed(mesh, name);
  std::vector<Polytope> parts;
  double hulls = 0.0;
  for (const auto& piece : pieces_of(mesh)) {
    parts.push_back(convex_piece(mesh, piece, name));
    hulls += mass_mesh(triangles_of(parts.back())).volume;
  }
  require_disjoint(parts, name);
  const MassProperties mass = mass_mesh(mesh);
  const double volume = mass.volume;
  if (std::abs(hulls - volume) > 1e-4 * volume)
    throw InputError(fmt::format(
        "{}: the solid is not convex: its volume is {:.6g} m3, that of the hulls of its {} pieces "
        "{:.6g} m3; divide it into closed convex pieces that do not overlap",
        name, volume, parts.size(), hulls));
  return make_polytope_shape(std::move(parts), mesh, mass);
}

}  // namespace ejecta
