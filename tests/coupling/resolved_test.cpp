#include "coupling/resolved/resolved.hpp"

#include <gtest/gtest.h>

#include <numbers>

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

/// Bodies as the compressible solvers see them.
CouplingSetup forced(double density, const Vec3& gravity = Vec3::Zero()) {
  CouplingSetup s;
  s.fluid_density = density;
  s.gravity = gravity;
  s.bodies = BodiesAs::forced_cells;
  return s;
}

TEST(ResolvedCoupling, FindsExactlyTheCellsInside) {
  const Grid grid = uniform(40);
  ResolvedCoupling coupling(grid, forced(1.2));
  SolidMask mask;
  const std::vector<Body> bodies{body_of(make_sphere(0.9), {0.11, -0.07, 0.03})};
  coupling.map(bodies, mask);
  int inside = 0;
  for (int k = 0; k < 40; ++k)
    for (int j = 0; j < 40; ++j)
      for (int i = 0; i < 40; ++i) inside += bodies[0].signed_distance(grid.centre(i, j, k)) < 0.0;
  EXPECT_EQ(static_cast<int>(mask.cells.size()), inside);
  const double volume = inside * std::pow(2.0 / 40, 3);
  EXPECT_NEAR(volume, std::numbers::pi / 6 * std::pow(0.9, 3), 0.02);
}

TEST(ResolvedCoupling, ImagePointsLieInTheFluid) {
  const Grid grid = uniform(40);
  ResolvedCoupling coupling(grid, forced(1.2));
  SolidMask mask;
  Body box = body_of(make_box({0.8, 0.8, 0.8}), {0.013, 0.021, -0.017});
  box.orientation = Quat(Eigen::AngleAxisd(0.4, Vec3(1, 2, 3).normalized()));
  const std::vector<Body> bodies{box};
  coupling.map(bodies, mask);
  int ghosts = 0;
  for (const SolidCell& c : mask.cells) {
    EXPECT_GE(c.ratio, Real(-1));
    EXPECT_LE(c.ratio, Real(0));
    if (c.ratio == Real(0)) continue;
    ++ghosts;
    Vec3 image = grid.centre(c.image_i, c.image_j, c.image_k);
    for (int d = 0; d < 3; ++d) image[d] += double(c.fraction[static_cast<std::size_t>(d)]) * 0.05;
    EXPECT_GT(box.signed_distance(image), 0.0);
  }
  EXPECT_GT(ghosts, 500);
}

TEST(ResolvedCoupling, OverlappingPartsCountOnce) {
  const Grid grid = uniform(48);
  ResolvedCoupling coupling(grid, forced(1.2));
  SolidMask mask;
  const std::vector<Body> bodies{body_of(make_cluster({1, 1, 1}, {3, 3, 3}, 0.5), Vec3::Zero())};
  coupling.map(bodies, mask);
  std::vector<int> seen(48 * 48 * 48, 0);
  for (const SolidCell& c : mask.cells) ++seen[static_cast<std::size_t>(c.i + 48 * (c.j + 48 * c.k))];
  EXPECT_EQ(*std::max_element(seen.begin(), seen.end()), 1);
  EXPECT_NEAR(double(mask.cells.size()) * std::pow(2.0 / 48, 3), 0.802, 0.02);
}

TEST(ResolvedCoupling, ForceIsTheImpulseTakenAndTorqueItsMoment) {
  const Grid grid = uniform(20);
  ResolvedCoupling coupling(grid, forced(2.0));
  SolidMask mask;
  std::vector<Body> bodies{body_of(make_sphere(0.6), {0.2, 0, 0})};
  bodies[0].motion = Motion::fixed;
  coupling.map(bodies, mask);
  Vec3 torque = Vec3::Zero();
  for (std::size_t n = 0; n < mask.cells.size(); ++n) {
    mask.impulse[n] = {0.0, -1e-6, 0.0};
    const SolidCell& c = mask.cells[n];
    torque += (grid.centre(c.i, c.j, c.k) - bodies[0].position).cross(Vec3(0, 1e-6 / 1e-3, 0));
  }
  std::vector<Load> loads(1);
  coupling.collect(bodies, mask, 1e-3, loads);
  EXPECT_NEAR(loads[0].force.y(), 1e-6 / 1e-3 * double(mask.cells.size()), 1e-12);
  EXPECT_LT((loads[0].torque - torque).norm(), 1e-12);
}

TEST(ResolvedCoupling, ForceIsWhatTheWallsTookAndTorqueItsMoment) {
  const Grid grid = uniform(20);
  CouplingSetup setup;
  setup.fluid_density = 2.0;
  setup.gravity = {0, 0, -9.81};
  setup.body_force = {3, 0, 0};
  ResolvedCoupling coupling(grid, setup);
  SolidMask mask;
  const std::vector<Body> bodies{body_of(make_sphere(0.6), {0.2, 0, 0}),
                                 body_of(make_box({0.5, 0.5, 0.5}), {-0.4, 0, 0})};
  coupling.map(bodies, mask);
  EXPECT_TRUE(mask.cells.empty());
  ASSERT_EQ(mask.cut.pressure_impulse.size(), mask.cut.walls.size());
  ASSERT_EQ(mask.cut.friction_impulse.size(), mask.cut.walls.size());
  Vec3 torque = Vec3::Zero();
  int walls[2] = {0, 0};
  for (std::size_t n = 0; n < mask.cut.walls.size(); ++n) {
    const CutWall& w = mask.cut.walls[n];
    ASSERT_EQ(mask.cut.pressure_impulse[n], Vec3::Zero()) << "nothing given yet";
    ++walls[w.body];
    mask.cut.pressure_impulse[n] = {0.0, 2e-6, 0.0};
    mask.cut.friction_impulse[n] = {0.0, 0.0, -1e-6};
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
    EXPECT_LT((loads[b].force - by_volume - Vec3(0, 2e-3 * n, -1e-3 * n)).norm(), 1e-12);
  }
  EXPECT_LT((loads[0].torque - torque).norm(), 1e-12);
}

TEST(ResolvedCoupling, BodiesOutsideTheBoxAreLeftAlone) {
  const Grid grid = uniform(20);
  CouplingSetup cut = forced(1.2, {0, 0, -9.81});
  cut.bodies = BodiesAs::cut_cells;
  for (const CouplingSetup& setup : {forced(1.2, {0, 0, -9.81}), cut}) {
    ResolvedCoupling coupling(grid, setup);
    SolidMask mask;
    const std::vector<Body> bodies{body_of(make_sphere(0.5), {3, 0, 0})};
    coupling.map(bodies, mask);
    EXPECT_TRUE(mask.cells.empty());
    EXPECT_TRUE(mask.cut.empty());
    EXPECT_FALSE(coupling.any_inside(bodies));
    std::vector<Load> loads(1);
    coupling.collect(bodies, mask, 1e-3, loads);
    EXPECT_EQ(loads[0].force, Vec3(0, 0, 0));
  }
}

}  // namespace
}  // namespace ejecta
