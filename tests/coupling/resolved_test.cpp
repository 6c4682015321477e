#include "coupling/resolved/resolved.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace ejecta {
namespace {

Body body_of(Shape shape, const Vec3& position) {
  Body b{.name = "body", .shape = std::move(shape), .enters_at = {}};
  b.mass = 1.0;
  b.position = position;
  return b;
}

Grid uniform(int n) {
  const Axis a = make_axis({-1.0, 1.0}, {n}, {});
  return Grid(a, a, a);
}

/// Of spheroids of 1 : 10 and 2 : 1, a disc and a sphere; a needle drags its own volume across.
TEST(AddedMass, IsLambsOfEllipsoids) {
  const auto of = [](const Vec3& semi) {
    MassProperties m;
    m.volume = 4.0 / 3 * M_PI * semi.prod();
    for (int d = 0; d < 3; ++d) m.inertia(d, d) = 0.2 * m.volume * (semi.squaredNorm() - semi[d] * semi[d]);
    AddedMass a = added_mass(m, 1.0);
    a.mass /= m.volume;
    return a;
  };
  EXPECT_LT((of({1, 1, 1}).mass - Vec3::Constant(0.5)).norm(), 1e-9);
  EXPECT_LT(of({1, 1, 1}).inertia.norm(), 1e-9);
  EXPECT_LT((of({2, 1, 1}).mass - Vec3(0.210, 0.704, 0.704)).norm(), 1e-3);
  const AddedMass disc = of({1, 1, 0.002});
  EXPECT_NEAR(disc.mass.z() * 4.0 / 3 * M_PI * 0.002, 8.0 / 3, 0.02);
  EXPECT_NEAR(disc.inertia.x(), 16.0 / 45, 0.003);
  EXPECT_NEAR(of({200, 1, 1}).mass.y(), 1.0, 1e-3);
}

TEST(ResolvedCoupling, ForceIsWhatTheWallsTookAndTorqueItsMoment) {
  const Grid grid = uniform(20);
  CouplingSetup setup;
  setup.fluid_density = 2.0;
  setup.gravity = {0, 0, -9.81};
  setup.body_force = {3, 0, 0};
  ResolvedCoupling coupling(grid, setup);
  CutCells mask;
  std::vector<Body> bodies{body_of(make_sphere(0.6), {0.2, 0, 0}),
                           body_of(make_box({0.5, 0.5, 0.5}), {-0.4, 0, 0})};
  bodies[0].motion = Motion::fixed;
  coupling.map(bodies, mask);
  ASSERT_EQ(mask.pressure_impulse.size(), mask.walls.size());
  ASSERT_EQ(mask.friction_impulse.size(), mask.walls.size());
  Vec3 torque = Vec3::Zero();
  int walls[2] = {0, 0};
  for (std::size_t n = 0; n < mask.walls.size(); ++n) {
    const CutWall& w = mask.walls[n];
    ASSERT_EQ(mask.pressure_impulse[n], Vec3::Zero()) << "nothing given yet";
    ++walls[w.body];
    mask.pressure_impulse[n] = {0.0, 2e-6, 0.0};
    mask.friction_impulse[n] = {0.0, 0.0, -1e-6};
    if (w.body == 0) torque += (w.point - bodies[0].position).cross(Vec3(0, 2e-3, -1e-3));
  }
  std::vector<Load> loads(2);
  coupling.collect(bodies, mask, 1e-3, loads);
  for (std::size_t b = 0; b < 2; ++b) {
    ASSERT_GT(walls[b], 100);
    const double n = walls[b], volume = bodies[b].shape.mass_properties().volume;
    EXPECT_LT((coupling.parts()[b].pressure - Vec3(0, 2e-3 * n, 0)).norm(), 1e-12);
    EXPECT_LT((coupling.parts()[b].friction - Vec3(0, 0, -1e-3 * n)).norm(), 1e-12);
    const Vec3 by_volume = 2.0 * volume * Vec3(3, 0, 9.81);
    Vec3 right = by_volume + Vec3(0, 2e-3 * n, -1e-3 * n);
    if (b == 1) {  // free: it begins as if something had held it
      const double added = 0.5 * 2.0 * volume, lambda = added / (bodies[b].mass + added);
      right = (1.0 - lambda) * right - lambda * bodies[b].mass * setup.gravity;
    }
    EXPECT_LT((loads[b].force - right).norm(), 1e-12);
  }
  EXPECT_LT((loads[0].torque - torque).norm(), 1e-12);
}

TEST(ResolvedCoupling, BodiesOutsideTheBoxAreLeftAlone) {
  const Grid grid = uniform(20);
  CouplingSetup setup;
  setup.fluid_density = 1.2;
  setup.gravity = {0, 0, -9.81};
  ResolvedCoupling coupling(grid, setup);
  CutCells mask;
  const std::vector<Body> bodies{body_of(make_sphere(0.5), {3, 0, 0})};
  coupling.map(bodies, mask);
  EXPECT_TRUE(mask.empty());
  EXPECT_FALSE(coupling.any_inside(bodies));
  std::vector<Load> loads(1);
  coupling.collect(bodies, mask, 1e-3, loads);
  EXPECT_EQ(loads[0].force, Vec3(0, 0, 0));
}

}  // namespace
}  // namespace ejecta
