#include "coupling/resolved/resolved.hpp"

#include <gtest/gtest.h>

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
      const double lambda = 2.0 * volume / (bodies[b].mass + 2.0 * volume);
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
