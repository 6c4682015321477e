#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
#include "shape/convex_parts.hpp"
#include "shape/polytope_shape.hpp"
#include "shape/principal_axes.hpp"
#include "shape/shape_data.hpp"

namespace ejecta {
namespace {

constexpr double kRound = 1e-5;  // of the volume: what the 32-bit corners of an STL file may take or add

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
  find_seams(parts);
  for (Vec3& v : surface.vertices) {
    v = to_body(data->frame, v);
    data->bounding_radius = std::max(data->bounding_radius, v.norm());
  }
  for (const Polytope& p : parts)
    if (p.exact) data->bounding_radius = std::max(data->bounding_radius, p.exact->radius());
  data->smallest_feature = std::min(2 * data->bounding_radius, width_polytopes(parts));
  data->geometry = PolytopesGeometry{std::move(parts), std::move(surface)};
  return Shape(data);
}

Shape make_polyhedron(const std::vector<Vec3>& points) {
  Polytope hull = convex_hull(points);
  TriangleMesh surface = triangles_of(hull);
  const MassProperties mass = mass_mesh(surface);
  return make_polytope_shape({std::move(hull)}, std::move(surface), mass);
}

Shape make_mesh(const TriangleMesh& mesh, const std::string& name, double fit_error) {
  require_closed(mesh, name);
  const MassProperties mass = mass_mesh(mesh);
  std::vector<Polytope> parts = convex_pieces(mesh);
  // A hole through a piece leaves all of its corners on the hull: its volume tells.
  if (!parts.empty() && volume_polytopes(parts) <= (1 + kRound) * mass.volume) {
    require_disjoint(parts, name);
  } else {
    require_not_crossing(mesh, name);
    parts = convex_parts(mesh, fit_error, name);
    if (volume_polytopes(parts) < (1 - kRound) * mass.volume)
      throw InputError(fmt::format("{}: some of its pieces share space, which would be counted twice", name));
  }
  return make_polytope_shape(std::move(parts), mesh, mass);
}

}  // namespace ejecta
