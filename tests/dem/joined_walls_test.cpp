#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/units.hpp"
#include "scene.hpp"

/// Walls that lie beside each other, across periodic sides too, are one surface.
namespace ejecta {
namespace {

WallSpec block_from(double low, double high) {
  WallSpec w;
  w.name = "from " + std::to_string(low);
  w.kind = WallKind::box;
  w.size = Vec3(high - low, 0.1, 0.01);
  w.point = Vec3(0.5 * (low + high), 0, -5e-3);
  w.material = "stone";
  return w;
}

Case on_walls(const std::vector<BodySpec>& bodies, const std::vector<WallSpec>& walls) {
  MaterialSpec m = stone();
  m.friction = 0.0;
  m.restitution = 0.5;
  Case c = scene(m);
  c.environment.gravity = Vec3(0, 0, -9.81);
  c.bodies = bodies;
  c.walls = walls;
  return c;
}

BodySpec round_or_flat(bool round, double x, double speed) {
  const Vec3 at(x, 0.003, 5e-3), v(speed, 0, 0);
  return round ? ball("body", 10e-3, at, v) : box("body", Vec3::Constant(10e-3), at, v);
}

/// The motion of all bodies is that in `other`, but for whole periods.
void expect_same_motion(const Case& c, const Case& other, double time) {
  Particles p = make_particles(c), q = make_particles(other);
  for (double t = 0; t < time; t += 1e-3) {  // bodies come back between steps
    p.advance(1e-3);
    q.advance(1e-3);
  }
  for (std::size_t n = 0; n < c.bodies.size(); ++n) {
    const Body &a = p.bodies()[n], &b = q.bodies()[n];
    EXPECT_NEAR(a.position.z(), b.position.z(), 1e-8) << a.name;
    EXPECT_NEAR((a.velocity - b.velocity).norm(), 0, 1e-5) << a.name;
    EXPECT_NEAR((a.angular_velocity - b.angular_velocity).norm(), 0, 1e-3) << a.name;
  }
}

TEST(JoinedWalls, AreOneSurface) {
  for (const bool round : {true, false}) {
    SCOPED_TRACE(round);
    const BodySpec body = round_or_flat(round, -20e-3, 0.5);
    const Case plane = on_walls({body}, {floor_at(0)});
    expect_same_motion(on_walls({body}, {block_from(-0.1, 0), block_from(0, 0.1)}), plane, 0.1);
    expect_same_motion(on_walls({body}, {block_from(0, 0.1), block_from(-0.1, -0.01), block_from(-0.01, 0)}),
                       plane, 0.1);
  }
  const BodySpec rolling = round_or_flat(true, -20e-3, 0.5);
  expect_same_motion(on_walls({rolling}, {block_from(-0.1, 0), block_from(1e-5, 0.1)}),
                     on_walls({rolling}, {floor_at(0)}), 0.1);
}

/// Where walls lie on each other in one plane, or one in the other, a body is pushed once.
TEST(JoinedWalls, AreOneSurfaceWhereTheyOverlap) {
  WallSpec belt = floor_at(0), thick = block_from(-0.03, 0.02);
  belt.name = "belt";
  thick.size.z() *= 3;
  thick.point.z() *= 3;
  WallSpec sunk = block_from(-0.02, 0.03);
  sunk.point.z() -= 1e-3;
  const std::vector<std::vector<WallSpec>> floors{
      {floor_at(0), belt},
      {floor_at(0), block_from(-0.01, 0.03)},
      {block_from(-0.01, 0.03), floor_at(0)},
      {floor_at(0), floor_at(-1e-3)},
      {block_from(-0.1, 0.1), block_from(-0.01, 0.03)},
      {block_from(-0.1, 0.1), thick},
      {block_from(-0.1, 0.1), sunk},
      {block_from(-0.1, 0.01), block_from(-0.01, 0.1)},
      {block_from(-0.1, 0.1), block_from(-0.1, 0.1), block_from(-0.1, 0.1)}};
  for (const bool round : {true, false})
    for (const double drop : {0.0, 2e-3})
      for (std::size_t n = 0; n < floors.size(); ++n) {
        SCOPED_TRACE(fmt::format("{}, from {} m, floor {}", round ? "ball" : "box", drop, n));
        BodySpec body = round_or_flat(round, -20e-3, 0.5);
        body.position.z() += drop;
        Case over = on_walls({body}, floors[n]), plane = on_walls({body}, {floor_at(0)});
        over.materials[0].friction = plane.materials[0].friction = round ? 0.4 : 0.0;
        expect_same_motion(over, plane, 0.1);
      }
}

TEST(JoinedWalls, AcrossAPeriodicSideToo) {
  for (const bool round : {true, false}) {
    SCOPED_TRACE(round);
    const BodySpec body = round_or_flat(round, 90e-3, 2.0);
    Case c = on_walls({body}, {block_from(0, 0.1)});
    c.domain.x = {0.0, 0.1};
    c.domain.periodic = {"x"};
    expect_same_motion(c, on_walls({body}, {floor_at(0)}), 0.6);
  }
}

/// What a body remembers of its contacts goes with it to the other side.
TEST(JoinedWalls, WhoRidesOnAnotherCrossesASideWithIt) {
  const std::vector<BodySpec> bodies{
      box("rider", Vec3::Constant(10e-3), Vec3(92e-3, 0, 15e-3), Vec3(2, 0, 0)),
      box("below", Vec3(30e-3, 30e-3, 10e-3), Vec3(90e-3, 0, 5e-3), Vec3(2, 0, 0))};
  Case c = on_walls(bodies, {floor_at(0)});
  c.domain.x = {0.0, 0.2};
  c.domain.periodic = {"x"};
  expect_same_motion(c, on_walls(bodies, {floor_at(0)}), 0.6);
}

/// Behind the end of a block is not behind its top.
TEST(JoinedWalls, ABallComesFromTheRimOntoTheTop) {
  const BodySpec body = round_or_flat(true, 0.5e-3, 0.5);
  expect_same_motion(on_walls({body}, {block_from(0, 0.1)}), on_walls({body}, {floor_at(0)}), 0.15);
}

/// A first touch that falls on a step is as thick as rounding leaves it: no place to push.
TEST(JoinedWalls, AFaceThatLandsIsNotTurnedByRounding) {
  for (const Vec3& size : {Vec3(10e-3, 10e-3, 10e-3), Vec3(20e-3, 10e-3, 5e-3)})
    for (const double wide : {0.06, 2.0}) {
      Case c = on_walls({box("body", size, Vec3(0, 0, 0.5 * size.z() + 0.3e-3), Vec3(0, 0, -1))},
                        {block_from(-0.5 * wide, 0.5 * wide)});
      c.materials[0].restitution = 0.1;
      Particles p = make_particles(c);
      for (int n = 0; n < 20; ++n) {
        p.advance(0.1e-3);
        EXPECT_LT(p.bodies()[0].angular_velocity.norm(), 1e-2) << n;  // 13 of noise
      }
    }
}

/// The place that is proposed for a body that overlaps others is one where it can start.
TEST(JoinedWalls, AProposedPlaceIsFree) {
  BodySpec tetrahedron = ball("body", 0, Vec3(3e-3, 3e-3, 3e-3));
  tetrahedron.shape = ShapeKind::polyhedron;
  tetrahedron.vertices = {{0, 0, -10e-3}, {9e-3, 0, 6e-3}, {-9e-3, 2e-3, 6e-3}, {0, -9e-3, 6e-3}};
  WallSpec side = floor_at(0);
  side.name = "side";
  side.normal = Vec3(1, 0, 0);
  Case c = on_walls({tetrahedron}, {floor_at(0), side, block_from(0, 0.02)});
  try {
    make_particles(c);
    FAIL() << "it overlaps two walls";
  } catch (const InputError& e) {
    const std::string& line = e.advice.example;
    std::size_t end = 0;
    for (int k = 0; k < 3; ++k) {
      const std::size_t begin = line.find('"', end) + 1;
      end = line.find('"', begin);
      c.bodies[0].position[k] = parse_quantity(line.substr(begin, end - begin), Dimension::length);
      ++end;
    }
    EXPECT_NO_THROW(make_particles(c)) << line;
  }
}

}  // namespace
}  // namespace ejecta
