#include "simulation/grid_walls.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "case/expression.hpp"

namespace ejecta {
namespace {

constexpr const char* kFaces[] = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};

bool in_plane(const Vec3& normal, double offset, const Vec3& inward, double at, double size) {
  return normal.dot(inward) > 1.0 - 1e-9 && std::abs(offset - at) <= 1e-6 * size;
}

/// A wall of the case has a surface in the plane inward . x = at.
bool stands_there(const Wall& wall, const Vec3& inward, double at, double size) {
  if (wall.is_plane) return in_plane(wall.normal, wall.offset, inward, at, size);
  return std::ranges::any_of(wall.surface->regions(), [&](const Surface::Region& r) {
    return in_plane(r.plane.normal, r.plane.offset, inward, at, size);
  });
}

/// Velocity of a wall's surface, m/s. One that changes in space or time drags the fluid alone (`check` says
/// so).
Vec3 surface_velocity(const BoundarySpec& face) {
  Vec3 v(0, 0, 0);
  if (face.type != BoundaryType::moving_wall || !face.state.velocity) return v;
  for (int d = 0; d < 3; ++d) {
    const Expression f((*face.state.velocity)[static_cast<std::size_t>(d)]);
    if (!f.is_constant()) return Vec3::Zero();
    v[d] = f(0, 0, 0, 0);
  }
  return v;
}

}  // namespace

std::vector<Wall> grid_walls(const Case& c, const Grid& grid, const Particles& particles) {
  std::vector<Wall> walls;
  if ((c.bodies.empty() && c.grains.empty()) || grid.axisymmetric()) return walls;
  // Thick enough that no dent comes near the other side.
  double thickness = 0.0;
  for (const Body& b : particles.bodies()) thickness = std::max(thickness, 2.0 * b.shape.bounding_radius());
  if (c.bodies.empty()) thickness = 0.1 * (grid.upper() - grid.lower()).minCoeff();
  const Vec3 size = grid.upper() - grid.lower(), middle = 0.5 * (grid.lower() + grid.upper());
  for (int f = 0; f < 6; ++f) {
    const BoundarySpec& face = c.boundary[static_cast<std::size_t>(f)];
    const int d = f / 2;
    if (!grid.active(d) || (face.type != BoundaryType::wall && face.type != BoundaryType::moving_wall))
      continue;
    Vec3 inward = Vec3::Zero();
    inward[d] = f % 2 ? -1.0 : 1.0;
    const double at = inward[d] * (f % 2 ? grid.upper() : grid.lower())[d];
    const auto mine = particles.walls();
    if (std::any_of(mine.begin(), mine.end(),
                    [&](const Wall& w) { return stands_there(w, inward, at, size.maxCoeff()); }))
      continue;
    WallSpec slab;
    slab.name = fmt::format("boundary.{}", kFaces[f]);
    slab.kind = WallKind::box;
    slab.size = size;
    slab.size[d] = thickness;
    slab.point = middle;
    slab.point[d] = inward[d] * (at - 0.5 * thickness);
    slab.velocity = surface_velocity(face);
    slab.material = c.bodies.empty() ? c.grains.front().material : c.bodies.front().material;
    walls.push_back(make_wall(slab, particles.materials(), ""));
  }
  return walls;
}

}  // namespace ejecta
