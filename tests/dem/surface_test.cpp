#include "dem/surface.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.hpp"
#include "surface_scenes.hpp"

/// Triangles are only a description: what the plain shape does, they do.
namespace ejecta {
namespace {

using testing::HasSubstr;

const Quat kAskew(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));

/// Where a body is and how it moves after 50 ms on a wall; all of it turned and moved.
Body after(const Wall& wall, const Shape& shape, const Vec3& position, const Vec3& velocity, const Quat& turn,
           const Vec3& by) {
  const Case c = scene(stone());
  const Materials materials(c);
  Particles p(turn * Vec3(0, 0, -9.81), materials, c.contact);
  p.add(wall);
  Body b = body_of("body", shape, materials);
  b.orientation = turn * b.orientation;
  b.position = turn * position + by;
  b.velocity = turn * velocity;
  p.add(b);
  for (int n = 0; n < 50; ++n) p.advance(1e-3);
  Body end = p.bodies()[0];
  end.position = turn.conjugate() * (end.position - by);
  end.velocity = turn.conjugate() * end.velocity;
  return end;
}

Wall box_wall(const Vec3& half, const Materials& materials) {
  WallSpec spec = floor_at(-half.z());
  spec.kind = WallKind::box;
  spec.size = 2 * half;
  return make_wall(spec, materials, "");
}

/// A ball and a cube dropped on face, edge and corner of a block, as triangles and as a box.
TEST(Surface, ABlockOfTrianglesIsABox) {
  const Case c = scene(stone());
  const Materials materials(c);
  const Vec3 half(30e-3, 30e-3, 10e-3);
  for (const Shape& shape : {make_sphere(10e-3), make_box(Vec3(10e-3, 8e-3, 6e-3))})
    for (const Vec3& at : {Vec3(1e-3, 2e-3, 10e-3), Vec3(31e-3, 3e-3, 10e-3), Vec3(31e-3, 31e-3, 10e-3)}) {
      const Body right =
          after(box_wall(half, materials), shape, at, Vec3(0.1, 0.05, -0.5), Quat::Identity(), Vec3(0, 0, 0));
      for (const int n : {1, 4})
        for (const Quat& turn : {Quat::Identity(), kAskew}) {
          const Vec3 by = turn.w() == 1 ? Vec3(0, 0, 0) : Vec3(0.2, -0.1, 0.3);
          const Wall wall =
              wall_of(moved(block_mesh(half, n), turn.toRotationMatrix(), by - turn * Vec3(0, 0, half.z())));
          const Body b = after(wall, shape, at, Vec3(0.1, 0.05, -0.5), turn, by);
          EXPECT_NEAR((b.velocity - right.velocity).norm(), 0, 1e-5) << at.transpose() << ", divided " << n;
          EXPECT_NEAR((b.position - right.position).norm(), 0, 1e-6) << at.transpose() << ", divided " << n;
        }
    }
}

/// Squares whose corners lie on the middles of their neighbours' edges, and slivers: edges in common with
/// nobody.
/// Solids that are thin at the edges on which they lie: nothing has gone through them there. And those whose
/// box has its middle outside of them stand on the side on which they are.
TEST(Surface, AcuteBodiesRestOnAnythingAsOnAPlane) {
  const double a = 4e-3;
  const std::vector<std::pair<const char*, std::vector<Vec3>>> bodies{
      {"corner", {{0, 0, 0}, {a, 0, 0}, {0, a, 0}, {0, 0, a}}},
      {"corner on its large face", {{0, 0, 0}, {0, -a, 0}, {-a, 0, 0}, {0, 0, -a}}},
      {"pyramid", {{-a, -a, 0}, {a, -a, 0}, {a, a, 0}, {-a, a, 0}, {0, 0, a}}},
      {"wedge", {{0, 0, 0}, {1.5 * a, 0, 0}, {0, a, 0}, {1.5 * a, a, 0}, {0, 0, a}, {0, a, a}}}};
  MaterialSpec material = stone();
  material.restitution = 0.3;
  const Case c = scene(material);
  const Materials materials(c);
  const auto resting = [&](const std::vector<Vec3>& corners, bool large, int on) {
    Particles p(Vec3(0, 0, -9.81), materials, c.contact);
    WallSpec w = floor_at(0);
    w.size = Vec3(100e-3, 100e-3, 20e-3);
    if (on == 1) w.kind = WallKind::box, w.point.z() = -10e-3;
    if (on < 2) p.add(make_wall(w, materials, ""));
    if (on == 2 || on == 3) p.add(wall_of(flat_mesh(on == 2 ? 1 : 7, 50e-3), on == 3));
    if (on == 4)
      p.add(wall_of(moved(block_mesh(Vec3(50e-3, 50e-3, 10e-3), 2), Mat3::Identity(), Vec3(0, 0, -10e-3))));
    if (on == 5) {
      Body block = body_of("block", make_box(w.size), materials);
      block.position.z() = -10e-3;
      block.motion = Motion::fixed;
      p.add(block);
    }
    const Quat down = large ? Quat::FromTwoVectors(Vec3(-1, -1, -1), Vec3(0, 0, -1)) : Quat::Identity();
    const Quat tilt(Eigen::AngleAxisd(0.03, Vec3(0.6, 0.8, 0)));
    const Shape shape = make_polyhedron(corners);
    Body b = body_of("body", shape, materials);
    b.orientation = tilt * down * b.orientation;
    b.position.z() = 5e-3;
    b.velocity.z() = -0.3;
    const int n = p.add(b);
    const double start = p.energy().kinetic + p.energy().potential;
    for (int k = 0; k < 120; ++k) {
      p.advance(1e-3);
      EXPECT_LT(p.energy().kinetic + p.energy().potential, start * (1 + 1e-6));
    }
    return p.bodies()[static_cast<std::size_t>(n)].position.z();
  };
  for (const auto& [name, corners] : bodies) {
    const bool large = std::string_view(name).ends_with("face");
    const double plane = resting(corners, large, 0);
    EXPECT_GT(plane, 0.0) << name;
    for (int on = 1; on < 6; ++on)
      EXPECT_NEAR(resting(corners, large, on), plane, 2e-5) << name << " on " << on;
  }
}

TEST(Surface, ABallRollsOverEdgesThatDoNotMatch) {
  TriangleMesh mesh;
  for (int row = 0; row < 8; ++row)
    for (int n = 0; n < 9; ++n) {
      const double w = 10e-3, x = w * (n - 4.5 + 0.5 * (row % 2)), y = w * (row - 4);
      const int a = static_cast<int>(mesh.vertices.size());
      for (const Vec3& v : {Vec3(x, y, 0), Vec3(x + w, y, 0), Vec3(x + w, y + w, 0), Vec3(x, y + w, 0)})
        mesh.vertices.push_back(v);
      mesh.triangles.push_back({a, a + 1, a + 2});
      mesh.triangles.push_back({a, a + 2, a + 3});
    }
  const Case c = scene(stone());
  const Materials materials(c);
  for (const Shape& shape : {make_sphere(6e-3), make_cluster(Vec3::Constant(6e-3), {3, 3, 3}, 3e-3),
                             make_box(Vec3::Constant(6e-3))}) {
    const Vec3 at(-20e-3, 0, 3e-3), v(0.5, 0.1, 0);
    const Body right =
        after(make_wall(floor_at(0), materials, ""), shape, at, v, Quat::Identity(), Vec3(0, 0, 0));
    const Body b = after(wall_of(mesh), shape, at, v, Quat::Identity(), Vec3(0, 0, 0));
    EXPECT_NEAR((b.position - right.position).norm(), 0, 2e-6) << shape.balls().size() << " balls";
    EXPECT_NEAR((b.velocity - right.velocity).norm(), 0, 2e-4) << shape.balls().size() << " balls";
  }
}

TEST(Surface, ClosedSheetsOfAnyThicknessHold) {
  for (const double thickness : {0.1e-3, 0.5e-3, 2e-3})
    for (const double diameter : {0.5e-3, 10e-3}) {
      const Wall sheet = wall_of(moved(block_mesh(Vec3(30e-3, 30e-3, 0.5 * thickness), 3), Mat3::Identity(),
                                       Vec3(0, 0, -0.5 * thickness)));
      const Body b = after(sheet, make_sphere(diameter), Vec3(7e-3, 3e-3, 0.6 * diameter), Vec3(0, 0, 0),
                           Quat::Identity(), Vec3(0, 0, 0));
      EXPECT_NEAR(b.position.z(), 0.5 * diameter, 0.01 * diameter) << thickness << " " << diameter;
    }
}

/// From behind, a body passes; on its way back it is held. With two sides both hold.
TEST(Surface, AnOpenSheetHasOneSideOrTwo) {
  const Case c = scene(stone());
  const Materials materials(c);
  for (const int n : {1, 6})
    for (const Shape& shape : {make_sphere(10e-3), make_box(Vec3::Constant(8e-3))})
      for (const bool two : {false, true}) {
        Particles p(Vec3(0, 0, two ? 0.0 : -9.81), materials, c.contact);
        p.add(wall_of(flat_mesh(n, 30e-3), two));
        Body b = body_of("body", shape, materials);
        b.position = Vec3(0.3e-3, 0.2e-3, -8e-3);
        b.velocity = Vec3(0, 0, 1);
        p.add(b);
        double fastest = 0.0;
        for (int k = 0; k < 400; ++k) {
          p.advance(1e-3);
          fastest = std::max(fastest, p.bodies()[0].velocity.norm());
          if (two && k == 30) break;
        }
        EXPECT_LT(fastest, 1 + 1e-9);
        if (two) EXPECT_NEAR(p.bodies()[0].velocity.z(), -0.3, 0.02);
        else EXPECT_NEAR(p.bodies()[0].position.z(), shape.bounding_radius() > 6e-3 ? 4e-3 : 5e-3, 1e-4);
      }
}

/// 10 m/s on a plate that the dent goes through, and on one it does not.
TEST(Surface, ADentDeeperThanThePlateIsPushedBack) {
  Case c = scene(stone());
  c.contact.time_step = 5e-6;  // one for all: before a thin plate it would be shorter
  const Materials materials(c);
  double rebound[3];
  int n = 0;
  for (const double thickness : {1e-3, 2e-3, 20e-3}) {
    WallSpec spec = floor_at(0);
    spec.kind = WallKind::plate;
    spec.size = Vec3(0.1, 0.1, thickness);
    Particles p(Vec3(0, 0, 0), materials, c.contact);
    p.add(make_wall(spec, materials, ""));
    Body b = body_of("cube", make_box(Vec3::Constant(20e-3)), materials);
    b.position = Vec3(1e-3, 2e-3, 11e-3);
    b.velocity = Vec3(0, 0, -10);
    p.add(b);
    for (int k = 0; k < 30; ++k) p.advance(1e-3);
    rebound[n++] = p.bodies()[0].velocity.z();
    EXPECT_GT(p.peaks(0).overlap, 2e-3);
    EXPECT_EQ(p.warnings().size(), 1u);
  }
  EXPECT_NEAR(rebound[0], rebound[2], 1e-6);
  EXPECT_NEAR(rebound[1], rebound[2], 1e-6);
  EXPECT_NEAR(rebound[2], 3.0, 0.2);
}

/// A step across the periodic side is the step in the middle; a floor that reaches over the sides holds once.
TEST(Surface, WallsHaveImages) {
  for (const bool round : {true, false}) {
    double speed[2];
    for (const int across : {0, 1}) {
      Case c = scene(stone());
      c.domain.x = {0.0, 0.1};
      c.domain.periodic = {"x"};
      WallSpec step = floor_at(0);
      step.kind = WallKind::box;
      step.point = Vec3(across ? 5e-3 : 55e-3, 0, 5e-3);
      step.size = Vec3(10e-3, 0.1, 10e-3);
      WallSpec floor = step;
      floor.name = "ground";
      floor.point = Vec3(0.05, 0, -10e-3);
      floor.size = Vec3(0.3, 0.1, 20e-3);
      c.walls = {step, floor};
      const Vec3 at(across ? 60e-3 : 10e-3, 0, 5e-3), v(1, 0, 0);
      c.environment.gravity = Vec3(0, 0, -9.81);
      c.bodies = {round ? ball("body", 10e-3, at, v) : box("body", Vec3::Constant(10e-3), at, v)};
      Particles p = make_particles(c);
      for (int n = 0; n < 60; ++n) p.advance(1e-3);
      speed[across] = p.bodies()[0].velocity.x();
      EXPECT_GT(p.bodies()[0].position.z(), round ? 4.9e-3 : 4.0e-3);
    }
    EXPECT_LT(speed[0], -0.05);
    EXPECT_NEAR(speed[0], speed[1], 1e-3);
  }
}

/// A wall that reaches over a periodic side, or lies beyond it, is met wherever its images are.
TEST(Surface, WallsBeyondASideAreMetInside) {
  for (const bool round : {true, false})
    for (const double place : {0.0, 41e-3, 45e-3, 50e-3, 60e-3, 100e-3, -55e-3}) {
      Case c = scene(stone());
      c.domain.x = {-0.05, 0.05};
      c.domain.periodic = {"x"};
      WallSpec step = floor_at(0);
      step.kind = WallKind::box;
      step.point = Vec3(place, 0, 0);
      step.size = Vec3(20e-3, 0.1, 20e-3);
      c.walls = {step};
      // 20 mm from the wall's right face, wherever in the domain that is
      double x = place + 30e-3;
      while (x >= 0.05) x -= 0.1;
      const Vec3 at(x, 0, 0), v(-1, 0, 0);
      c.bodies = {round ? ball("body", 8e-3, at, v) : box("body", Vec3::Constant(8e-3), at, v)};
      Particles p = make_particles(c);
      for (int n = 0; n < 30; ++n) p.advance(1e-3);
      EXPECT_NEAR(p.bodies()[0].velocity.x(), 0.3, 0.02) << place << (round ? " ball" : " box");
      c.bodies[0].position = Vec3(place > 0.04 ? place - 0.1 : place < -0.04 ? place + 0.1 : place, 0, 0);
      if (std::abs(c.bodies[0].position.x()) < 0.05) EXPECT_THROW(make_particles(c), InputError) << place;
    }
}

TEST(Surface, WhoEntersInAWallIsRefused) {
  Case c = scene(stone());
  WallSpec block = floor_at(0);
  block.kind = WallKind::box;
  block.size = Vec3::Constant(0.1);
  block.name = "block";
  for (const Vec3& at : {Vec3(0, 0, 0.049), Vec3(0, 0, 0)}) {
    c.walls = {block};
    c.bodies = {ball("ball", 10e-3, at)};
    c.bodies[0].enters_at = 1e-3;
    try {
      make_particles(c);
      FAIL() << "accepted";
    } catch (const InputError& e) {
      EXPECT_THAT(e.what(), HasSubstr("overlaps wall \"block\""));
      EXPECT_THAT(e.what(), HasSubstr("where it is to enter"));
    }
  }
}

}  // namespace
}  // namespace ejecta
