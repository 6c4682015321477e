#include "dem/walls.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "shape/convex_parts.hpp"
#include "shape/mass_properties.hpp"
#include "shape/stl.hpp"

namespace ejecta {
namespace {

constexpr double kSameVolume = 1e-5;  // what the 32-bit corners of an STL file may take or add

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

void require_area(const TriangleMesh& mesh, const std::string& name) {
  for (std::size_t n = 0; n < mesh.triangles.size(); ++n) {
    const auto corner = [&](std::size_t c) -> const Vec3& {
      return mesh.vertices[static_cast<std::size_t>(mesh.triangles[n][c])];
    };
    const Vec3 a = corner(1) - corner(0), b = corner(2) - corner(0);
    const double longest = std::max({a.norm(), b.norm(), (a - b).norm()});
    if (!(a.cross(b).norm() > 1e-12 * longest * longest))
      throw InputError(fmt::format("{}: triangle {} is degenerate (no area)", name, n + 1));
  }
}

/// Two triangles that run the same way along the edge they share look to different sides: one of them is a
/// hole to what comes from there.
void require_one_side(const TriangleMesh& mesh, const std::string& name) {
  std::map<std::pair<int, int>, std::vector<std::size_t>> edges;  // from, to -> triangles
  for (std::size_t n = 0; n < mesh.triangles.size(); ++n)
    for (std::size_t c = 0; c < 3; ++c)
      edges[{mesh.triangles[n][c], mesh.triangles[n][(c + 1) % 3]}].push_back(n);
  const auto corners = [&](std::size_t n) {
    std::array<int, 3> sorted = mesh.triangles[n];
    std::sort(sorted.begin(), sorted.end());
    return sorted;
  };
  for (const auto& [edge, along] : edges)
    if (along.size() == 2 && !edges.contains({edge.second, edge.first}) &&
        corners(along[0]) != corners(along[1]))
      throw InputError(
          fmt::format("{}: triangles {} and {} run the same way along the edge they share: one of "
                      "them is inside out, a hole to what comes from there",
                      name, along[0] + 1, along[1] + 1),
          {.key = "file",
           .expected = "triangles that all look to one side, or both sides of an open surface",
           .example = "two_sided = true"});
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
      const TriangleMesh mesh = placed(read_stl(path, spec.scale), spec);
      require_area(mesh, path);
      if (!spec.two_sided) require_one_side(mesh, path);
      wall.surface = std::make_shared<Surface>(mesh, spec.two_sided);
      if (const double volume = mass_mesh(mesh).volume; wall.surface->closed() && volume > 0) {
        wall.solids = convex_pieces(mesh);
        if (std::abs(volume_polytopes(wall.solids) - volume) > kSameVolume * volume) wall.solids.clear();
        find_seams(wall.solids);
      }
      return wall;
    }
    require_size(spec.size);
    wall.solids = {spec.kind == WallKind::box
                       ? moved(polytope_box(0.5 * spec.size), turn_of(spec), spec.point)
                       : slab(spec.point, wall.normal, spec.size)};
    wall.surface = std::make_shared<Surface>(triangles_of(wall.solids.front()));
    return wall;
  } catch (const InputError& e) {
    throw InputError(fmt::format("wall \"{}\": {}", spec.name, e.what()), e.advice);
  }
}

}  // namespace ejecta
