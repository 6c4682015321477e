#include "shape/polytope.hpp"

#include <gtest/gtest.h>

#include <random>

#include "base/error.hpp"
#include "shape/shape.hpp"

namespace ejecta {
namespace {

std::vector<Vec3> rock(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<Vec3> points;
  for (int n = 0; n < count; ++n)
    points.push_back(
        Vec3(normal(random), normal(random), normal(random)).normalized().cwiseProduct(Vec3(1, 0.8, 0.6)));
  return points;
}

TEST(ConvexHull, CubeWithPointsInsideHasSixFaces) {
  std::vector<Vec3> points = polytope_box(Vec3(1, 2, 3)).vertices;
  for (const Vec3& p : rock(50, 1)) points.push_back(0.9 * p);
  points.push_back(Vec3(1, 0, 0));  // in the middle of a face
  const Polytope hull = convex_hull(points);
  EXPECT_EQ(hull.faces.size(), 6u);
  EXPECT_EQ(hull.vertices.size(), 8u);
  EXPECT_NEAR(mass_mesh(triangles_of(hull)).volume, 48.0, 1e-12);
}

TEST(ConvexHull, RockIsClosedConvexAndHoldsAllPoints) {
  const std::vector<Vec3> points = rock(102, 7);
  const Polytope hull = convex_hull(points);
  EXPECT_EQ(hull.vertices.size(), 102u);
  EXPECT_EQ(hull.faces.size(), 200u);  // Euler: 2 V - 4
  EXPECT_NO_THROW(require_closed(triangles_of(hull), "rock"));
  for (const Vec3& p : points)
    for (const auto& f : hull.faces) EXPECT_LE(f.normal.dot(p), f.offset + 1e-8);
}

/// Points of a lattice on the faces of a turned block: many on one line and in one plane, but for round-off.
/// The hull has to close however it falls.
TEST(ConvexHull, TurnedBlockOfManyPointsHasSixFaces) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (const double thin : {1.0, 0.1, 8e-3, 3e-4})
    for (const int n : {1, 2, 3, 4, 7})
      for (int turn = 0; turn < 60; ++turn) {
        const Vec3 half = 30e-3 * Vec3(1, 1, thin), axis(normal(random), normal(random), normal(random));
        const Quat rotation(Eigen::AngleAxisd(2 * M_PI * uniform(random), axis.normalized()));
        const Vec3 shift = 0.1 * Vec3(uniform(random), uniform(random), uniform(random));
        std::vector<Vec3> points;
        for (int k = 0; k <= n; ++k)
          for (int j = 0; j <= n; ++j)
            for (int i = 0; i <= n; ++i) {
              if (i % n && j % n && k % n) continue;  // inside
              points.push_back(shift + rotation * half.cwiseProduct(Vec3(2.0 * i / n - 1, 2.0 * j / n - 1,
                                                                         2.0 * k / n - 1)));
            }
        const Polytope hull = convex_hull(points);
        EXPECT_EQ(hull.faces.size(), 6u) << n << " divisions, thickness " << thin;
        EXPECT_NEAR(mass_mesh(triangles_of(hull)).volume / (8 * half.prod()), 1.0, 1e-6);
      }
}

TEST(ConvexHull, RefusesFlatPoints) {
  EXPECT_THROW(convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 3, 0}}), InputError);
}

/// Mass properties of a 200-face rock: the mesh's sums against tetrahedra from a far point, in long double.
TEST(Polyhedron, MassOfARockIsExact) {
  const Polytope hull = convex_hull(rock(102, 3));
  const TriangleMesh mesh = triangles_of(hull);
  long double volume = 0, second[3][3] = {}, first[3] = {};
  for (const auto& t : mesh.triangles) {
    long double c[3][3];
    for (std::size_t i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k)
        c[i][k] = static_cast<long double>(mesh.vertices[static_cast<std::size_t>(t[i])][k]) - 2.0L;
    const long double v = (c[0][0] * (c[1][1] * c[2][2] - c[1][2] * c[2][1]) -
                           c[0][1] * (c[1][0] * c[2][2] - c[1][2] * c[2][0]) +
                           c[0][2] * (c[1][0] * c[2][1] - c[1][1] * c[2][0])) /
                          6;
    volume += v;
    for (int j = 0; j < 3; ++j) {
      const long double sj = c[0][j] + c[1][j] + c[2][j];
      first[j] += v * sj / 4;
      for (int k = 0; k < 3; ++k) {
        long double s = sj * (c[0][k] + c[1][k] + c[2][k]);
        for (auto& corner : c) s += corner[j] * corner[k];
        second[j][k] += v * s / 20;
      }
    }
  }
  const MassProperties m = mass_mesh(mesh);
  EXPECT_NEAR(m.volume, static_cast<double>(volume), 1e-10 * m.volume);
  for (int j = 0; j < 3; ++j) {
    EXPECT_NEAR(m.centre[j], static_cast<double>(first[j] / volume + 2), 1e-10);
    for (int k = 0; k < 3; ++k) {
      const auto central = [&](int a, int b) { return second[a][b] - first[a] * first[b] / volume; };
      const long double exact =
          j == k ? central(0, 0) + central(1, 1) + central(2, 2) - central(j, k) : -central(j, k);
      EXPECT_NEAR(m.inertia(j, k), static_cast<double>(exact), 1e-10 * m.inertia(0, 0));
    }
  }
}

TEST(Polyhedron, DistanceIsExactInsideAndOut) {
  const Polytope box = polytope_box(Vec3(1, 2, 3));
  const Shape exact = make_box(Vec3(2, 4, 6));
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-5, 5);
  for (int n = 0; n < 2000; ++n) {
    const Vec3 p(u(random), u(random), u(random));
    const NearestPoint q = nearest_on_polytope(box, p);
    EXPECT_NEAR(q.distance, exact.signed_distance(p), 1e-12);
    EXPECT_NEAR((q.normal - exact.gradient(p)).norm(), 0.0, 1e-9);
  }
}

}  // namespace
}  // namespace ejecta
