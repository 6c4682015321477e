#include "shape/fit_spheres.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/error.hpp"
#include "shape/shape.hpp"

namespace ejecta {
namespace {

using testing::HasSubstr;

void add(TriangleMesh& mesh, const TriangleMesh& more, const Vec3& shift) {
  const int first = static_cast<int>(mesh.vertices.size());
  for (const Vec3& v : more.vertices) mesh.vertices.push_back(v + shift);
  for (const auto& t : more.triangles) mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

/// An L of three cubes of 4 mm, one closed surface that is not convex.
TriangleMesh angle() {
  const double e = 4e-3;
  const Vec3 outline[] = {{0, 0, 0}, {2 * e, 0, 0}, {2 * e, e, 0}, {e, e, 0}, {e, 2 * e, 0}, {0, 2 * e, 0}};
  TriangleMesh m;
  for (const double z : {0.0, e})
    for (const Vec3& p : outline) m.vertices.push_back(p + Vec3(0, 0, z));
  for (const auto& t : {std::array{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}) {
    m.triangles.push_back({t[0], t[2], t[1]});
    m.triangles.push_back({t[0] + 6, t[1] + 6, t[2] + 6});
  }
  for (int n = 0; n < 6; ++n) {
    const int next = (n + 1) % 6;
    m.triangles.push_back({n, next, next + 6});
    m.triangles.push_back({n, next + 6, n + 6});
  }
  return m;
}

/// Farthest that a random point of the surface lies from the spheres, and that a sphere sticks out of the box
/// `low` to `high`.
double farthest(const TriangleMesh& mesh, const std::vector<Ball>& balls) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(0, 1);
  double worst = 0.0;
  for (const auto& t : mesh.triangles)
    for (int n = 0; n < 3000; ++n) {
      double a = u(random), b = u(random);
      if (a + b > 1) a = 1 - a, b = 1 - b;
      const Vec3& corner = mesh.vertices[static_cast<std::size_t>(t[0])];
      const Vec3 p = corner + a * (mesh.vertices[static_cast<std::size_t>(t[1])] - corner) +
                     b * (mesh.vertices[static_cast<std::size_t>(t[2])] - corner);
      double nearest = 1e300;
      for (const Ball& ball : balls) nearest = std::min(nearest, (p - ball.centre).norm() - ball.radius);
      EXPECT_GT(nearest, -1e-9) << "a sphere sticks out";
      worst = std::max(worst, nearest);
    }
  return worst;
}

TEST(FitSpheres, StaysWithinTheStatedError) {
  for (const double error : {1e-3, 0.5e-3}) {
    const TriangleMesh mesh = angle();
    const std::vector<Ball> balls = fit_spheres(mesh, error, "angle.stl");
    EXPECT_LT(farthest(mesh, balls), error);
    EXPECT_GT(balls.size(), 20u);
    EXPECT_LT(balls.size(), 400u);
  }
}

TEST(FitSpheres, ASphereNeedsOne) {
  TriangleMesh mesh = icosphere(3);
  for (Vec3& v : mesh.vertices) v *= 5e-3;
  const std::vector<Ball> balls = fit_spheres(mesh, 0.5e-3, "ball.stl");
  EXPECT_LE(balls.size(), 2u);
  EXPECT_LT(farthest(mesh, balls), 0.5e-3);
}

TEST(FitSpheres, SaysWhichErrorIsPossible) {
  try {
    fit_spheres(angle(), 1e-6, "angle.stl");
    FAIL() << "accepted";
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("angle.stl"));
    EXPECT_EQ(e.advice.key, "fit_error");
    EXPECT_THAT(e.advice.expected, HasSubstr("at least 0.29"));
  }
}

/// A solid that is not convex, given as convex parts that touch.
TEST(MeshParts, TouchButMayNotOverlap) {
  const TriangleMesh cube = make_box(Vec3::Constant(4e-3)).surface();
  TriangleMesh two = cube;
  add(two, cube, Vec3(4e-3, 0, 0));
  const Shape bar = make_mesh(two, "bar");
  EXPECT_NEAR(bar.mass_properties().volume, 2 * 64e-9, 1e-18);
  EXPECT_EQ(bar.polytopes().size(), 2u);
  TriangleMesh overlapping = cube;
  add(overlapping, cube, Vec3(3e-3, 1e-3, 1e-3));
  try {
    make_mesh(overlapping, "bar");
    FAIL() << "accepted";
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("convex pieces overlap"));
  }
}

}  // namespace
}  // namespace ejecta
