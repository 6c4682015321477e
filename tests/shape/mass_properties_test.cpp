#include "shape/mass_properties.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "shape/shape.hpp"

namespace ejecta {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(MassBalls, SeparateBallsAdd) {
  const MassProperties m = mass_balls({{Vec3(-2, 0, 0), 1.0}, {Vec3(2, 1, 0), 1.0}});
  EXPECT_NEAR(m.volume, 8.0 / 3.0 * kPi, 1e-9);
  EXPECT_NEAR((m.centre - Vec3(0, 0.5, 0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR(m.inertia(2, 2), m.volume * (0.4 + 4.25), 1e-8);
}

TEST(MassBalls, TwoOverlappingBallsMatchTheLens) {
  const double d = 0.7;  // distance of centres, unit radii
  const double lens = kPi * (4 + d) * (2 - d) * (2 - d) / 12.0;
  for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 0, 1), Vec3(1, 2, 3)}) {
    const MassProperties m = mass_balls({{Vec3(0, 0, 0), 1.0}, {d * axis.normalized(), 1.0}});
    EXPECT_NEAR(m.volume, 8.0 / 3.0 * kPi - lens, 1e-7);
    EXPECT_NEAR((m.centre - 0.5 * d * axis.normalized()).norm(), 0.0, 1e-7);
  }
}

TEST(MassBalls, BallInsideAnotherCountsOnce) {
  const MassProperties m = mass_balls({{Vec3(0, 0, 0), 1.0}, {Vec3(0.1, 0, 0.2), 0.5}, {Vec3(0, 0, 0), 1.0}});
  EXPECT_NEAR(m.volume, 4.0 / 3.0 * kPi, 1e-9);
  EXPECT_NEAR(m.inertia(0, 0), 0.4 * m.volume, 1e-9);
}

/// Volume and inertia per mass against the box they stand for; the figures are from counting 160^3 voxels.
TEST(MassBalls, ClustersOfThePaper) {
  const MassProperties cube = make_cluster(Vec3(10, 10, 10), {3, 3, 3}, 5.0).mass_properties();
  EXPECT_NEAR(cube.volume / 1000.0, 0.802, 5e-4);
  EXPECT_NEAR(cube.inertia(0, 0) / cube.volume / (200.0 / 12), 0.8364, 2e-4);
  EXPECT_NEAR(cube.inertia(2, 2), cube.inertia(0, 0), 1e-7 * cube.inertia(0, 0));
  const MassProperties flat = make_cluster(Vec3(10, 10, 5), {3, 3, 1}, 5.0).mass_properties();
  EXPECT_NEAR(flat.volume / 500.0, 0.719, 5e-4);
  EXPECT_NEAR(flat.inertia(0, 0) / flat.volume / (125.0 / 12), 0.7798, 2e-4);
  EXPECT_NEAR(flat.inertia(2, 2) / flat.volume / (200.0 / 12), 0.7941, 2e-4);
}

TEST(Superquadric, EllipsoidAndNearlyABox) {
  const Shape ellipsoid = make_superquadric(Vec3(2, 4, 6), 2, 2);
  const MassProperties& m = ellipsoid.mass_properties();
  EXPECT_NEAR(m.volume, 4.0 / 3.0 * kPi * 6, 1e-12);
  EXPECT_NEAR(m.inertia(2, 2), m.volume * (1 + 4) / 5, 1e-12);
  EXPECT_NEAR(m.inertia(0, 0), m.volume * (4 + 9) / 5, 1e-12);
  EXPECT_NEAR(mass_mesh(ellipsoid.surface()).volume / m.volume, 1.0, 0.01);
  const MassProperties box = make_superquadric(Vec3(2, 4, 6), 20, 20).mass_properties();
  EXPECT_NEAR(box.volume, 48, 0.02 * 48);
  EXPECT_NEAR(box.inertia(0, 0), 208, 0.03 * 208);
  const Shape rounded = make_superquadric(Vec3(1, 1, 2), 4, 3);
  EXPECT_NEAR(mass_mesh(rounded.surface()).volume / rounded.mass_properties().volume, 1.0, 0.02);
  EXPECT_NEAR(mass_mesh(rounded.surface()).inertia(0, 0) / rounded.mass_properties().inertia(0, 0), 1.0,
              0.03);
}

TEST(MassMesh, BoxFarFromTheOriginIsExact) {
  TriangleMesh mesh = make_box(Vec3(1, 2, 3)).surface();
  for (Vec3& v : mesh.vertices) v += Vec3(100, -50, 20);
  const MassProperties m = mass_mesh(mesh), exact = mass_box(Vec3(1, 2, 3));
  EXPECT_NEAR(m.volume, 6.0, 1e-11);
  EXPECT_NEAR((m.centre - Vec3(100, -50, 20)).norm(), 0.0, 1e-11);
  EXPECT_NEAR((m.inertia - exact.inertia).norm(), 0.0, 1e-10);
}

}  // namespace
}  // namespace ejecta
