#include "shape/shape.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.hpp"

namespace ejecta {
namespace {

std::vector<std::pair<const char*, Shape>> all_shapes() {
  return {
      {"sphere", make_sphere(2.0)},
      {"box", make_box(Vec3(1, 2, 3))},
      {"two balls", make_multisphere({{Vec3(0, 0, 0), 1.0}, {Vec3(1, 0.5, 0), 0.7}})},
      {"cluster", make_cluster(Vec3(1, 1, 0.5), {3, 3, 1}, 0.5)},
      {"polyhedron", make_polyhedron({{0, 0, 0}, {2, 0, 0}, {0, 1.5, 0}, {0.3, 0.2, 1.8}, {1.5, 1.4, 1.1}})},
      {"superquadric", make_superquadric(Vec3(1, 2, 1.5), 3, 4)},
      {"mesh", make_mesh(icosphere(1), "icosphere")}};
}

TEST(Shape, SurfaceIsClosedAndLiesOnTheZeroDistance) {
  for (const auto& [name, shape] : all_shapes()) {
    const TriangleMesh mesh = shape.surface(0.01);
    EXPECT_NO_THROW(require_closed(mesh, name));
    for (const Vec3& v : mesh.vertices) EXPECT_NEAR(shape.signed_distance(v), 0.0, 0.02) << name;
    EXPECT_NEAR(mass_mesh(mesh).volume / shape.mass_properties().volume, 1.0, 0.03) << name;
  }
}

TEST(Shape, SupportIsFarthestOfTheSurface) {
  for (const auto& [name, shape] : all_shapes())
    for (const Vec3& d : {Vec3(1, 0, 0), Vec3(-0.3, 0.4, 1), Vec3(0.2, -1, -0.7)}) {
      const double reach = shape.support(d).dot(d);
      for (const Vec3& v : shape.surface().vertices) EXPECT_LE(v.dot(d), reach + 0.01) << name;
      EXPECT_NEAR(shape.signed_distance(shape.support(d)), 0.0, 1e-9) << name;
      EXPECT_LE(shape.support(d).norm(), shape.bounding_radius() * (1 + 1e-12)) << name;
    }
}

TEST(Shape, GradientIsTheSlopeOfTheDistance) {
  const double h = 1e-6;
  for (const auto& [name, shape] : all_shapes())
    for (const Vec3& p : {Vec3(1.3, 0.9, 1.8), Vec3(-1.1, 0.4, -0.2), Vec3(0.31, -0.52, 0.11)}) {
      Vec3 slope;
      for (int c = 0; c < 3; ++c)
        slope[c] =
            (shape.signed_distance(p + h * Vec3::Unit(c)) - shape.signed_distance(p - h * Vec3::Unit(c))) /
            (2 * h);
      EXPECT_NEAR((slope - shape.gradient(p)).norm(), 0.0, 1e-6) << name;
    }
}

TEST(Shape, ProjectedAreas) {
  EXPECT_NEAR(make_sphere(2.0).projected_area(Vec3(1, 2, 3)), std::numbers::pi, 1e-12);
  EXPECT_NEAR(make_box(Vec3(1, 2, 3)).projected_area(Vec3(0, 0, 5)), 2.0, 1e-12);
  EXPECT_NEAR(make_box(Vec3(1, 1, 1)).projected_area(Vec3(1, 1, 1)), std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(make_cluster(Vec3(10, 10, 10), {3, 3, 3}, 5.0).projected_area(Vec3(0, 0, 1)), 92.468, 0.01);
}

TEST(Shape, BodyAxesArePrincipalAndCentred) {
  const Shape s = make_multisphere({{Vec3(5, 5, 5), 1.0}, {Vec3(6.0, 5.5, 5), 0.7}});
  const BodyFrame& f = s.frame();
  // The long axis joins the centres; a point of the user's maps onto the surface.
  const Vec3 along = f.rotation * Vec3::UnitX();
  EXPECT_NEAR(along.cross(Vec3(1, 0.5, 0).normalized()).norm(), 0.0, 1e-6);
  EXPECT_NEAR(s.signed_distance(f.rotation.conjugate() * (Vec3(4, 5, 5) - f.centre)), 0.0, 1e-9);
}

/// The farthest point along a direction is the surface's own, and a cap lacks the same share of its volume
/// wherever it is cut from an ellipsoid: pi d^2 (h - d/3) a b c/h^3 for a depth d below a top at the height h
/// (a sphere's, mapped).
TEST(Superquadric, CapsFollowTheSmoothSurface) {
  const Vec3 half(5, 4, 3);
  double least = 1.0, most = 0.0;
  for (int n = 0; n < 40; ++n) {
    const Vec3 normal = Vec3(std::sin(3.0 * n), std::cos(5.0 * n), std::sin(2.0 * n + 1)).normalized();
    for (const double exponent : {1.0, 1.5, 2.0, 3.0, 8.0, 20.0}) {
      const Superquadric s{half, exponent, exponent};
      const Vec3 top = s.support(normal);
      EXPECT_NEAR(s.gauge(top), 1.0, 1e-12);
      for (const Vec3& d : icosphere(2).vertices)
        EXPECT_LE(normal.dot(d) / s.gauge(d), normal.dot(top) + 1e-12);
      for (const double depth : {1e-9, 1e-4, 0.1, 1.0}) {
        Polytope cap;
        if (!cut_cap(s, normal, depth, cap)) continue;
        const double height = normal.dot(top), volume = volume_polytope(cap), share = depth / height;
        EXPECT_GT(volume, 0.0);
        for (const Vec3& v : cap.vertices) {
          EXPECT_NEAR(s.gauge(v), 1.0, 1e-12);
          EXPECT_GE(normal.dot(v), height - depth - 1e-12);
        }
        if (exponent != 2.0 || depth < 1e-4) continue;
        const double exact = M_PI * share * share * (1 - share / 3) * half.prod();
        least = std::min(least, volume / exact);
        most = std::max(most, volume / exact);
      }
    }
  }
  EXPECT_GT(least, 0.93);
  EXPECT_LT(most - least, 0.01);
}

TEST(Shape, RefusesLengthsThatAreNot) {
  EXPECT_THROW(make_sphere(0.0), InputError);
  EXPECT_THROW(make_sphere(std::nan("")), InputError);
  EXPECT_THROW(make_box(Vec3(1, -1, 1)), InputError);
  EXPECT_THROW(make_multisphere({}), InputError);
  EXPECT_THROW(make_superquadric(Vec3(1, 1, 1), 0.5, 2), InputError);
  EXPECT_THROW(make_cluster(Vec3(1, 1, 1), {3, 3, 3}, 2.0), InputError);
}

}  // namespace
}  // namespace ejecta
