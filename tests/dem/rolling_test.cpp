#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "surface_scenes.hpp"

/// Smooth bodies roll: of a contact that stays the same nothing is lost, whatever the restitution.
namespace ejecta {
namespace {

constexpr double kWide = 10e-3, kRolling = 0.2;  // m, m/s

enum class Ground { plane, box, divided, body };

Particles rolling(double restitution, const Shape& shape, Ground ground, const Vec3& axis, const Quat& turn) {
  constexpr double radius = 0.5 * kWide;
  MaterialSpec m = stone();
  m.restitution = restitution;
  m.friction = 0.5;
  const Case c = scene(m);
  const Materials materials(c);
  Particles p(turn * Vec3(0, 0, -9.81), materials, c.contact);
  WallSpec w = floor_at(0);
  w.normal = turn * Vec3(0, 0, 1);
  if (ground == Ground::box) {
    w.kind = WallKind::box;
    w.size = Vec3(0.4, 0.4, 20e-3);
    w.point = turn * Vec3(0, 0, -10e-3);
    w.rotation_axis = Eigen::AngleAxisd(turn).axis();
    w.rotation_angle = Eigen::AngleAxisd(turn).angle();
  }
  if (ground == Ground::divided) {
    p.add(wall_of(moved(flat_mesh(40, 0.2), turn.toRotationMatrix(), Vec3(0, 0, 0))));
  } else if (ground == Ground::body) {
    Body slab = body_of("slab", make_box(Vec3(0.4, 0.4, 20e-3)), materials);
    slab.position = turn * Vec3(0, 0, -10e-3);
    slab.orientation = turn;
    slab.motion = Motion::fixed;
    p.add(slab);
  } else {
    p.add(make_wall(w, materials, ""));
  }
  Body b = body_of("round", shape, materials);
  const Vec3 up = turn * Vec3(0, 0, 1), spin = turn * axis.normalized();
  if (axis.x() == 0) b.orientation = Quat(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitX())) * b.orientation;
  b.orientation = turn * b.orientation;
  b.position = radius * up;
  b.velocity = kRolling * spin.cross(up);
  b.angular_velocity = kRolling / radius * spin;
  p.add(b);
  return p;
}

double speed_after(double seconds, Particles p) {
  p.advance(seconds);
  return p.bodies().back().velocity.norm();
}

TEST(Rolling, SmoothBodiesKeepTheirSpeed) {
  const Quat level = Quat::Identity(), tilted(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
  const Vec3 oblique(0.3, 1, 0), upright(0, 1, 0);
  const std::vector<std::tuple<const char*, Shape, Vec3>> shapes{
      {"superquadric sphere", make_superquadric(kWide * Vec3(1, 1, 1), 2, 2), oblique},
      {"spheroid", make_superquadric(kWide * Vec3(1, 1, 0.6), 2, 2), upright},
      {"rounded cylinder", make_superquadric(kWide * Vec3(1, 1, 1), 2, 4), upright}};
  for (const auto& [name, shape, axis] : shapes)
    for (const double e : {0.1, 0.5, 1.0})
      for (const Ground ground : {Ground::plane, Ground::box, Ground::divided, Ground::body})
        EXPECT_NEAR(speed_after(0.1, rolling(e, shape, ground, axis, ground == Ground::box ? tilted : level)),
                    kRolling, 0.01 * kRolling)
            << name << ", restitution " << e << ", ground " << int(ground);
}

/// What a mesh of a sphere loses are impacts of its facets: the finer they are the less.
TEST(Rolling, FacetsCostLessTheFinerTheyAre) {
  double before = 0.5 * kRolling;
  for (const int level : {2, 3, 4}) {
    TriangleMesh mesh = icosphere(level);
    for (Vec3& v : mesh.vertices) v *= 0.5 * kWide;
    const double speed = speed_after(
        0.1, rolling(0.1, make_mesh(mesh, "sphere"), Ground::plane, Vec3(0.3, 1, 0), Quat::Identity()));
    EXPECT_GT(speed, before) << mesh.triangles.size() << " triangles";
    before = speed;
  }
  EXPECT_GT(before, 0.99 * kRolling);
}

/// A face that rocks on the ground, always pressed all over, comes to rest.
TEST(Rolling, FacesThatRockComeToRest) {
  MaterialSpec m = stone();
  m.restitution = 0.5;
  const Case c = scene(m);
  const Materials materials(c);
  Particles p(Vec3(0, 0, -500), materials, c.contact);
  p.add(make_wall(floor_at(0), materials, ""));
  Body b = body_of("box", make_box(Vec3::Constant(kWide)), materials);
  b.position.z() = 0.5 * kWide;
  b.angular_velocity = Vec3(0.2, 0.1, 0);
  p.add(b);
  p.advance(0.05);
  EXPECT_LT(p.bodies()[0].angular_velocity.norm(), 2e-3);
}

}  // namespace
}  // namespace ejecta
