#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "scene.hpp"

/// Boxes and polyhedra that drop, slide, roll and stand.
namespace ejecta {
namespace {

constexpr double kEdge = 10e-3;  // m

Case on_floor(double restitution, double friction) {
  MaterialSpec m = stone();
  m.restitution = restitution;
  m.friction = friction;
  Case c = scene(m);
  c.environment.gravity = Vec3(0, 0, -9.81);
  c.walls = {floor_at(0)};
  return c;
}

BodySpec turned(BodySpec b, const Vec3& axis, double angle) {
  b.rotation_axis = axis;
  b.rotation_angle = angle;
  return b;
}

double mechanical(const Particles& p) {
  const DemEnergy e = p.energy();
  return e.kinetic + e.potential + e.elastic;
}

/// Face, edge, corner and askew; elastic, no friction: a second on the floor with many bounces.
TEST(Cube, ElasticDropKeepsItsEnergy) {
  const struct {
    Vec3 axis;
    double angle;
  } turns[] = {{Vec3(0, 0, 1), 0.0},
               {Vec3(0, 1, 0), M_PI / 4},
               {Vec3(1, -1, 0), std::acos(1 / std::sqrt(3.0))},
               {Vec3(1, 0.3, 0.2), 0.4},
               {Vec3(0.1, 1, 0), 0.02}};
  for (const auto& t : turns) {
    Case c = on_floor(1.0, 0.0);
    c.bodies = {turned(box("cube", Vec3::Constant(kEdge), Vec3(0, 0, 40e-3)), t.axis, t.angle)};
    Particles p = make_particles(c);
    const double before = mechanical(p);
    double worst = 0;
    int bounces = 0;
    bool down = true;
    for (int n = 0; n < 2000; ++n) {
      p.advance(5e-4);
      worst = std::max(worst, std::abs(mechanical(p) / before - 1));
      const bool now_down = p.bodies()[0].velocity.z() < 0;
      bounces += down && !now_down;
      down = now_down;
    }
    EXPECT_LT(worst, 0.005) << t.axis.transpose() << " " << t.angle;
    EXPECT_GE(bounces, 4);
  }
}

/// A convex rock of 200 faces bounces and rolls elastically: as smooth as the box.
TEST(Rock, ElasticDropKeepsItsEnergy) {
  Case c = on_floor(1.0, 0.0);
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  BodySpec rock = box("rock", Vec3(0, 0, 0), Vec3(0, 0, 30e-3));
  rock.shape = ShapeKind::polyhedron;
  for (int n = 0; n < 102; ++n)
    rock.vertices.push_back(Vec3(normal(random), normal(random), normal(random))
                                .normalized()
                                .cwiseProduct(Vec3(8e-3, 6e-3, 5e-3)));
  rock.spin = Vec3(5, 10, 0);
  c.bodies = {rock};
  Particles p = make_particles(c);
  ASSERT_EQ(p.bodies()[0].shape.polytopes()[0].faces.size(), 200u);
  const double before = mechanical(p);
  double worst = 0;
  for (int n = 0; n < 800; ++n) {
    p.advance(1e-3);
    worst = std::max(worst, std::abs(mechanical(p) / before - 1));
  }
  EXPECT_LT(worst, 0.005);
  EXPECT_GT(p.peaks(0).force, 5 * p.bodies()[0].mass * 9.81);
}

/// The paper's 27 spheres with the mass of the box they stand for, on the same drop on a corner: they touch
/// later, are stiffer than a sharp corner and so are pushed harder (without damping 3.3 N by Hertz's law, the
/// corner 4 E/h = 1.8 N).
TEST(Cube, ClusterAndBoxOnACornerDiffer) {
  Case c = on_floor(0.3, 0.5);
  const BodySpec solid = turned(box("box", Vec3::Constant(kEdge), Vec3(0, 0, 40e-3)), Vec3(1, -1, 0),
                                std::acos(1 / std::sqrt(3.0)));
  BodySpec cluster = solid;
  cluster.shape = ShapeKind::cluster;
  cluster.sphere_diameter = 5e-3;
  cluster.true_box_mass = true;
  cluster.position.x() = 0.1;
  c.bodies = {solid, cluster};
  Particles p = make_particles(c);
  EXPECT_NEAR(p.bodies()[0].mass, p.bodies()[1].mass, 1e-12);
  EXPECT_NEAR(p.bodies()[0].inertia.x(), p.bodies()[1].inertia.x(), 1e-15);
  double lowest[2] = {1, 1};
  for (int n = 0; n < 1200; ++n) {
    p.advance(1e-4);
    for (std::size_t b = 0; b < 2; ++b) lowest[b] = std::min(lowest[b], p.bodies()[b].position.z());
  }
  // A corner of the box lies sqrt(3) 5 mm from the centre, the cluster's 2.5 mm (sqrt(3) + 1).
  EXPECT_LT(lowest[0], std::sqrt(3.0) * 5e-3);
  EXPECT_LT(lowest[1], 2.5e-3 * (std::sqrt(3.0) + 1));
  EXPECT_GT(lowest[0] - lowest[1], 0.5e-3);
  EXPECT_GT(p.peaks(1).force, 1.5 * p.peaks(0).force);
}

double slide(double degrees) {
  Case c = on_floor(0.3, 0.5);
  const double a = degrees * M_PI / 180;
  c.environment.gravity = 9.81 * Vec3(std::sin(a), 0, -std::cos(a));
  c.bodies = {box("cube", Vec3(20e-3, 20e-3, 10e-3), Vec3(0, 0, 5e-3))};
  Particles p = make_particles(c);
  p.advance(0.5);
  const double before = p.bodies()[0].position.x();
  p.advance(0.5);
  return p.bodies()[0].position.x() - before;
}

TEST(Cube, SlidesAboveTheFrictionAngleAndStandsBelow) {
  const double angle = std::atan(0.5) * 180 / M_PI;
  EXPECT_LT(std::abs(slide(angle - 0.2)), 1e-6);
  const double a = (angle + 0.2) * M_PI / 180, acceleration = 9.81 * (std::sin(a) - 0.5 * std::cos(a));
  EXPECT_NEAR(slide(angle + 0.2), acceleration * 0.375, 0.1 * acceleration * 0.375);
}

/// A box released on its edge just before or behind the balance falls to that side, without sliding.
TEST(Cube, RollsOverItsEdge) {
  for (const double side : {-1.0, 1.0}) {
    Case c = on_floor(0.1, 2.0);
    c.bodies = {turned(box("box", Vec3::Constant(kEdge), Vec3(0, 0, kEdge / std::sqrt(2.0))), Vec3(0, 1, 0),
                       M_PI / 4 + side * 0.02)};
    Particles p = make_particles(c);
    p.advance(1.0);
    const Body& b = p.bodies()[0];
    EXPECT_NEAR(b.position.x(), side * kEdge / 2, 0.05 * kEdge);
    EXPECT_NEAR(b.position.z(), kEdge / 2, 1e-4);
    EXPECT_LT(b.velocity.norm(), 1e-4);
  }
}

TEST(Cube, SpinningOnItsFaceComesToRest) {
  Case c = on_floor(0.3, 0.5);
  c.bodies = {box("cube", Vec3::Constant(kEdge), Vec3(0, 0, kEdge / 2))};
  c.bodies[0].spin = Vec3(0, 0, 20);
  Particles p = make_particles(c);
  p.advance(0.5);
  EXPECT_LT(p.bodies()[0].angular_velocity.norm(), 1e-3);
}

TEST(Stack, FiveBoxesStandForTenSeconds) {
  Case c = on_floor(0.3, 0.5);
  for (int n = 0; n < 5; ++n)
    c.bodies.push_back(box("box " + std::to_string(n), Vec3::Constant(kEdge), Vec3(0, 0, (n + 0.5) * kEdge)));
  Particles p = make_particles(c);
  p.advance(10.0);
  for (int n = 0; n < 5; ++n) {
    const Body& b = p.bodies()[static_cast<std::size_t>(n)];
    EXPECT_NEAR(std::hypot(b.position.x(), b.position.y()), 0, 1e-5) << n;
    EXPECT_NEAR(b.position.z(), (n + 0.5) * kEdge, 1e-4) << n;
    EXPECT_LT(b.velocity.norm(), 1e-5) << n;
  }
}

TEST(Plate, BodyBalancesOnTheEdgeOfAFinitePlate) {
  Case c = on_floor(0.3, 0.5);
  WallSpec plate;
  plate.name = "plate";
  plate.kind = WallKind::plate;
  plate.material = "stone";
  plate.size = Vec3(0.1, 0.1, 2e-3);
  plate.point = Vec3(0.05, 0, 0);  // its edge is at x = 0
  for (const double x : {2e-3, -2e-3}) {
    c.walls = {plate};
    c.bodies = {box("cube", Vec3::Constant(kEdge), Vec3(x, 0, kEdge / 2))};
    Particles p = make_particles(c);
    p.advance(0.3);
    if (x > 0) EXPECT_NEAR(p.bodies()[0].position.z(), kEdge / 2, 1e-4);
    else EXPECT_LT(p.bodies()[0].position.z(), -5e-3);
  }
}

TEST(Belt, TakesABoxToItsSpeed) {
  Case c = on_floor(0.3, 0.5);
  c.walls[0].kind = WallKind::belt;
  c.walls[0].velocity = Vec3(3, 0, 0);
  c.bodies = {box("cube", Vec3::Constant(kEdge), Vec3(0, 0, kEdge / 2))};
  Particles p = make_particles(c);
  // Friction mu g stops the slip after v/(mu g); a wide box does not tip over.
  c.bodies[0].size = Vec3(30e-3, 30e-3, 10e-3);
  p = make_particles(c);
  p.advance(0.3);
  EXPECT_NEAR(p.bodies()[0].velocity.x(), 0.5 * 9.81 * 0.3, 0.02 * 0.5 * 9.81 * 0.3);
  p.advance(0.5);
  EXPECT_NEAR(p.bodies()[0].velocity.x(), 3.0, 0.01);
  const DemEnergy e = p.energy();
  EXPECT_NEAR(e.ledger(), 9.81 * p.bodies()[0].mass * 5e-3, 1e-3 * e.work);
}

/// Rocks fall on each other without walls' help to their momentum: no gravity, closed system.
TEST(Collision, MomentumIsConservedAndTheLedgerCloses) {
  MaterialSpec m = stone();
  m.rolling_friction = 0.05;
  Case c = scene(m);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> u(-1, 1);
  const Shape rock = make_polyhedron(icosphere(1).vertices);
  for (int n = 0; n < 27; ++n) {
    const Vec3 at = 14e-3 * Vec3(n % 3, n / 3 % 3, n / 9) - Vec3::Constant(14e-3);
    BodySpec b = n % 3 == 0 ? ball("ball", 10e-3, at) : box("box", Vec3(8e-3, 7e-3, 6e-3), at);
    if (n % 3 == 2) {
      b.shape = ShapeKind::cluster;
      b.size = Vec3::Constant(8e-3);
      b.sphere_diameter = 4e-3;
    }
    b.velocity = -60 * at + 0.3 * Vec3(u(random), u(random), u(random));
    b.spin = 30 * Vec3(u(random), u(random), u(random));
    c.bodies.push_back(b);
  }
  Particles p = make_particles(c);
  const auto momentum = [&] {
    Vec3 sum(0, 0, 0);
    for (const Body& b : p.bodies()) sum += b.mass * b.velocity;
    return sum;
  };
  const auto angular = [&] {
    Vec3 sum(0, 0, 0);
    for (const Body& b : p.bodies()) sum += b.mass * b.position.cross(b.velocity) + b.angular_momentum();
    return sum;
  };
  const Vec3 before = momentum(), turning = angular();
  const double energy = p.energy().ledger();
  double scale = 0;
  for (const Body& b : p.bodies()) scale += b.mass * b.velocity.norm();
  for (int n = 0; n < 20; ++n) {
    p.advance(1e-3);
    EXPECT_NEAR(p.energy().ledger(), energy, 1e-3 * energy);
  }
  EXPECT_LT((momentum() - before).norm(), 1e-13 * scale);
  EXPECT_LT((angular() - turning).norm(), 1e-12 * scale * 0.04);
  EXPECT_GT(p.energy().dissipated, 0.3 * energy);
}

/// Steps in which things come farther than they are thick are divided: nothing passes through unseen.
TEST(FastThinThings, MeetEachOther) {
  MaterialSpec m = stone();
  m.youngs_modulus = 1e9;
  m.restitution = 0.5;
  for (const double speed : {30.0, 100.0})
    for (const double thickness : {0.2e-3, 1e-3}) {
      Case c = scene(m);
      c.contact.time_step_fraction = 0.5;
      BodySpec sheet = box("sheet", Vec3(20e-3, 20e-3, thickness), Vec3(0, 0, 0));
      sheet.motion = Motion::fixed;
      BodySpec plate = box("plate", Vec3(5e-3, 5e-3, thickness), Vec3(0, 0, 8e-3), Vec3(0, 0, -speed));
      BodySpec small = ball("small", 2e-3, Vec3(7e-3, 7e-3, -9e-3), Vec3(0, 0, speed));
      c.bodies = {sheet, plate, small};
      Particles p = make_particles(c);
      for (int n = 0; n < 40; ++n) p.advance(16e-3 / 20 / speed);
      EXPECT_NEAR(p.bodies()[1].velocity.z() / speed, 0.5, 0.1) << speed << " m/s, " << thickness << " m";
      EXPECT_NEAR(p.bodies()[2].velocity.z() / speed, -0.5, 0.1) << speed << " m/s, " << thickness << " m";
    }
}

}  // namespace
}  // namespace ejecta
