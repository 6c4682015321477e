#include "dem/walls.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "base/error.hpp"
#include "shape/shape.hpp"
#include "shape/stl.hpp"

namespace ejecta {
namespace {

void require_size(const Vec3& size) {
  if (!(size.minCoeff() > 0) || !size.allFinite())
    throw InputError(fmt::format("size = ({}, {}, {}) m must be positive", size.x(), size.y(), size.z()));
}

/// A slab whose outer face is centred on `point` and looks along `normal`; size: along its two tangents and
/// thickness. The tangents are those nearest to x and y (or z, for a normal along x).
Polytope slab(const Vec3& point, const Vec3& normal, const Vec3& size) {
  const Vec3 guess = std::abs(normal.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY();
  Mat3 axes;
  axes.col(0) = (guess - guess.dot(normal) * normal).normalized();
  axes.col(1) = normal.cross(axes.col(0));
  axes.col(2) = normal;
  return moved(polytope_box(0.5 * size), axes, point - 0.5 * size.z() * normal);
}

/// Prisms that reach `thickness` behind each triangle: flat parts act as one, however they are divided.
std::vector<Polytope> prisms(const TriangleMesh& mesh, double thickness, const std::string& name) {
  std::vector<Polytope> solids;
  for (std::size_t n = 0; n < mesh.triangles.size(); ++n) {
    std::vector<Vec3> corners;
    for (const int c : mesh.triangles[n]) corners.push_back(mesh.vertices[static_cast<std::size_t>(c)]);
    const Vec3 up = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    const double longest = std::max({(corners[1] - corners[0]).norm(), (corners[2] - corners[0]).norm(),
                                     (corners[2] - corners[1]).norm()});
    if (!(up.norm() > 1e-12 * longest * longest))
      throw InputError(fmt::format("{}: triangle {} is degenerate (no area)", name, n + 1));
    for (std::size_t c = 0; c < 3; ++c) corners.push_back(corners[c] - thickness * up.normalized());
    solids.push_back(convex_hull(corners));
  }
  return solids;
}

Mat3 turn_of(const WallSpec& spec) {
  return Eigen::AngleAxisd(spec.rotation_angle, spec.rotation_axis.normalized()).toRotationMatrix();
}

/// A surface from a file, turned about its origin, which then lies at `point`.
TriangleMesh placed(TriangleMesh mesh, const WallSpec& spec) {
  const Mat3 turn = turn_of(spec);
  for (Vec3& v : mesh.vertices) v = spec.point + turn * v;
  return mesh;
}

}  // namespace

Wall make_wall(const WallSpec& spec, const Materials& materials, const std::string& directory) {
  try {
    Wall wall;
    wall.name = spec.name;
    wall.material = materials.index(spec.material);
    wall.velocity = spec.velocity;
    if (spec.kind != WallKind::box && spec.kind != WallKind::mesh) {
      if (!(spec.normal.norm() > 0)) throw InputError("normal must not be zero");
      wall.normal = spec.normal.normalized();
      wall.offset = wall.normal.dot(spec.point);
    }
    const bool endless = spec.kind == WallKind::plane || (spec.kind == WallKind::belt && spec.size.isZero());
    if (endless) return wall;
    wall.is_plane = false;
    if (spec.kind == WallKind::mesh) {
      const std::string path = (std::filesystem::path(directory) / spec.file).string();
      const double thickness = spec.size.z() > 0 ? spec.size.z() : 1e-3;
      const TriangleMesh mesh = placed(read_stl(path, spec.scale), spec);
      wall.solids = prisms(mesh, thickness, path);
      wall.facets = make_facets(mesh, thickness);
      return wall;
    }
    require_size(spec.size);
    wall.solids = {spec.kind == WallKind::box
                       ? moved(polytope_box(0.5 * spec.size), turn_of(spec), spec.point)
                       : slab(spec.point, wall.normal, spec.size)};
    return wall;
  } catch (const InputError& e) {
    throw InputError(fmt::format("wall \"{}\": {}", spec.name, e.what()));
  }
}

}  // namespace ejecta
