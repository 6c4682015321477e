#include "coupling/resolved/resolved.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace ejecta {
namespace {

Body body_of(Shape shape, const Vec3& position) {
  Body b{.name = "body", .shape = std::move(shape)};
  b.mass = 1.0;
  b.position = position;
  return b;
}

Grid uniform(int n) {
  const Axis a = make_axis({-1.0, 1.0}, {n}, {});
  return Grid(a, a, a);
}

TEST(ResolvedCoupling, FindsExactlyTheCellsInside) {
  const Grid grid = uniform(40);
  ResolvedCoupling coupling(grid, 1.2, Vec3::Zero());
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
  ResolvedCoupling coupling(grid, 1.2, Vec3::Zero());
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
  ResolvedCoupling coupling(grid, 1.2, Vec3::Zero());
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
  ResolvedCoupling coupling(grid, 2.0, Vec3::Zero());
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

TEST(ResolvedCoupling, BodiesOutsideTheBoxAreLeftAlone) {
  const Grid grid = uniform(20);
  ResolvedCoupling coupling(grid, 1.2, Vec3(0, 0, -9.81));
  SolidMask mask;
  const std::vector<Body> bodies{body_of(make_sphere(0.5), {3, 0, 0})};
  coupling.map(bodies, mask);
  EXPECT_TRUE(mask.cells.empty());
  EXPECT_FALSE(coupling.any_inside(bodies));
  std::vector<Load> loads(1);
  coupling.collect(bodies, mask, 1e-3, loads);
  EXPECT_EQ(loads[0].force, Vec3(0, 0, 0));
}

}  // namespace
}  // namespace ejecta
