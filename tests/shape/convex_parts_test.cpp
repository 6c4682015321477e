#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "base/error.hpp"
#include "shape/convex_parts.hpp"
#include "shape/shape.hpp"

namespace ejecta {
namespace {

using testing::HasSubstr;

void add(TriangleMesh& mesh, const std::vector<Vec3>& corners, bool reversed = false) {
  const int first = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
  for (int n = 1; n + 1 < static_cast<int>(corners.size()); ++n)
    mesh.triangles.push_back({first, first + (reversed ? n + 1 : n), first + (reversed ? n : n + 1)});
}

/// Corners at the same place become one.
TriangleMesh welded(const TriangleMesh& soup) {
  TriangleMesh mesh;
  std::vector<int> name;
  for (const Vec3& v : soup.vertices) {
    int n = 0;
    while (n < static_cast<int>(mesh.vertices.size()) &&
           (mesh.vertices[static_cast<std::size_t>(n)] - v).norm() > 1e-12)
      ++n;
    if (n == static_cast<int>(mesh.vertices.size())) mesh.vertices.push_back(v);
    name.push_back(n);
  }
  for (const auto& t : soup.triangles)
    mesh.triangles.push_back({name[static_cast<std::size_t>(t[0])], name[static_cast<std::size_t>(t[1])],
                              name[static_cast<std::size_t>(t[2])]});
  return mesh;
}

/// Unit voxels, as one closed surface.
TriangleMesh blocks(const std::vector<std::array<int, 3>>& cells) {
  TriangleMesh soup;
  for (const auto& c : cells)
    for (int axis = 0; axis < 3; ++axis)
      for (const int side : {0, 1}) {
        auto next = c;
        next[static_cast<std::size_t>(axis)] += 2 * side - 1;
        if (std::find(cells.begin(), cells.end(), next) != cells.end()) continue;
        Vec3 low(c[0], c[1], c[2]);
        low[axis] += side;
        const Vec3 u = Vec3::Unit((axis + 1) % 3), v = Vec3::Unit((axis + 2) % 3);
        add(soup, {low, low + u, low + u + v, low + v}, side == 0);
      }
  return welded(soup);
}

/// A ring of `around` x `across` squares with radii 3 and 1.
TriangleMesh ring(int around, int across) {
  TriangleMesh soup;
  const auto at = [&](int i, int j) {
    const double a = 2 * std::numbers::pi * i / around, b = 2 * std::numbers::pi * j / across;
    return Vec3((3 + std::cos(b)) * std::cos(a), (3 + std::cos(b)) * std::sin(a), std::sin(b));
  };
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) add(soup, {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
  return welded(soup);
}

/// A sphere with dimples.
TriangleMesh dimpled(int levels) {
  TriangleMesh mesh = icosphere(levels);
  for (Vec3& v : mesh.vertices) v *= 1 - 0.1 * std::pow(std::sin(3 * v.x()) * std::cos(2 * v.y() + v.z()), 2);
  return mesh;
}

/// The winding number's fraction of a full solid angle: 1 inside, 0 outside (van Oosterom & Strackee 1983).
double winding(const TriangleMesh& mesh, const Vec3& p) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[static_cast<std::size_t>(t[0])] - p;
    const Vec3 b = mesh.vertices[static_cast<std::size_t>(t[1])] - p;
    const Vec3 c = mesh.vertices[static_cast<std::size_t>(t[2])] - p;
    const double x = a.norm(), y = b.norm(), z = c.norm();
    sum += 2 * std::atan2(a.dot(b.cross(c)), x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y);
  }
  return sum / (4 * std::numbers::pi);
}

double volume_of(const std::vector<Polytope>& parts) {
  double sum = 0;
  for (const Polytope& p : parts) sum += volume_polytope(p);
  return sum;
}

/// What the parts promise: no two share space, all of the solid is in them, and what is in them besides lies
/// within `error` of their surface. At random points and, for the depth, on the mesh itself.
void expect_divided(const TriangleMesh& mesh, const std::vector<Polytope>& parts, double error) {
  std::mt19937 random(7);
  Vec3 low = mesh.vertices.front(), high = low;
  for (const Vec3& v : mesh.vertices) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  std::uniform_real_distribution<double> unit(0, 1);
  for (int n = 0; n < 3000; ++n) {
    const Vec3 p = low + Vec3(unit(random), unit(random), unit(random)).cwiseProduct(high - low);
    int holders = 0;
    for (const Polytope& part : parts) holders += nearest_on_polytope(part, p).distance < -1e-9;
    const bool inside = winding(mesh, p) > 0.5;
    EXPECT_LE(holders, 1) << p.transpose();
    EXPECT_GE(holders, inside ? 1 : 0) << p.transpose();
    if (error > 0) continue;
    EXPECT_EQ(holders, inside ? 1 : 0) << p.transpose();
  }
  for (const auto& t : mesh.triangles) {
    double u = unit(random), v = unit(random);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const Vec3& a = mesh.vertices[static_cast<std::size_t>(t[0])];
    const Vec3 p = a + u * (mesh.vertices[static_cast<std::size_t>(t[1])] - a) +
                   v * (mesh.vertices[static_cast<std::size_t>(t[2])] - a);
    // On the sphere of this radius about p there is a point outside of all parts.
    bool open = false;
    for (int n = 0; n < 4000 && !open; ++n) {
      const Vec3 d(unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5);
      const Vec3 q = p + (1.02 * error + 1e-5) * d.normalized();
      open = std::all_of(parts.begin(), parts.end(),
                         [&](const Polytope& part) { return nearest_on_polytope(part, q).distance > 0; });
    }
    EXPECT_TRUE(open) << p.transpose();
  }
}

TEST(ConvexParts, AnAngleIsTwoBoxes) {
  const TriangleMesh mesh = blocks({{0, 0, 0}, {1, 0, 0}, {0, 0, 1}});
  const auto parts = convex_parts(mesh, 0, "angle");
  EXPECT_EQ(parts.size(), 2u);
  EXPECT_NEAR(volume_of(parts), 3, 1e-12);
  expect_divided(mesh, parts, 0);
}

/// Every corner of a frame lies on its hull: only the hole tells.
TEST(ConvexParts, AFrameIsFourBars) {
  std::vector<std::array<int, 3>> cells;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (i != 1 || j != 1) cells.push_back({i, j, 0});
  const TriangleMesh mesh = blocks(cells);
  const Shape shape = make_mesh(mesh, "frame");
  EXPECT_EQ(shape.polytopes().size(), 4u);
  EXPECT_NEAR(shape.mass_properties().volume, 8, 1e-12);
  EXPECT_NEAR(shape.mass_properties().inertia(2, 2), (9 * 18 - 2) / 12.0, 1e-12);
  EXPECT_NEAR(shape.signed_distance(Vec3(0, 0, 0)), 0.5, 1e-12);
  expect_divided(mesh, convex_parts(mesh, 0, "frame"), 0);
}

TEST(ConvexParts, AStaircaseInThreeDirections) {
  std::vector<std::array<int, 3>> cells;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; i + j < 3; ++j)
      for (int k = 0; i + j + k < 3; ++k) cells.push_back({i, j, k});
  const TriangleMesh mesh = blocks(cells);
  const auto parts = convex_parts(mesh, 0, "stairs");
  EXPECT_LE(parts.size(), 6u);
  EXPECT_NEAR(volume_of(parts), 10, 1e-12);
  expect_divided(mesh, parts, 0);
}

/// A shell inside out is a cavity.
TEST(ConvexParts, ACavity) {
  TriangleMesh mesh = make_box(Vec3(3, 3, 3)).surface();
  const TriangleMesh inner = make_box(Vec3(1, 1, 1)).surface();
  const int first = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), inner.vertices.begin(), inner.vertices.end());
  for (const auto& t : inner.triangles) mesh.triangles.push_back({first + t[0], first + t[2], first + t[1]});
  const Shape shape = make_mesh(mesh, "hollow");
  EXPECT_NEAR(shape.mass_properties().volume, 26, 1e-12);
  EXPECT_NEAR(shape.parts_volume(), 26, 1e-9);
  EXPECT_LE(shape.polytopes().size(), 6u);
  EXPECT_NEAR(shape.signed_distance(Vec3(0, 0, 0)), 0.5, 1e-12);
}

TEST(ConvexParts, ARingWithinAnError) {
  const TriangleMesh mesh = ring(24, 12);
  const double volume = mass_mesh(mesh).volume;
  std::size_t last = 1000;
  for (const double error : {0.1, 0.3}) {
    const auto parts = convex_parts(mesh, error, "ring");
    EXPECT_LT(parts.size(), last);
    last = parts.size();
    const double more = volume_of(parts) / volume - 1;
    EXPECT_GT(more, 0);
    EXPECT_LT(more, error);  // a layer of this thickness would be twice as much
    expect_divided(mesh, parts, error);
  }
  EXPECT_LE(last, 12u);
}

TEST(ConvexParts, MassIsThatOfTheMesh) {
  const TriangleMesh mesh = dimpled(2);
  const Shape shape = make_mesh(mesh, "dimpled", 0.005);
  EXPECT_GT(shape.polytopes().size(), 1u);
  EXPECT_DOUBLE_EQ(shape.mass_properties().volume, mass_mesh(mesh).volume);
}

/// Too many parts: the message names an error with which it works.
TEST(ConvexParts, NamesAnErrorThatWorks) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "takes minutes under the sanitizers; the smaller meshes above take the same ways";
#endif
  const TriangleMesh mesh = dimpled(3);
  InputError refusal("");
  try {
    make_mesh(mesh, "golf.stl");
  } catch (const InputError& e) {
    refusal = e;
  }
  ASSERT_THAT(refusal.what(), HasSubstr("golf.stl: the solid is not convex, and "));
  EXPECT_EQ(refusal.advice.key, "fit_error");
  const std::string example = refusal.advice.example;
  ASSERT_THAT(example, HasSubstr("fit_error = \""));
  const double error = 1e-3 * std::stod(example.substr(example.find('"') + 1));
  EXPECT_LE(convex_parts(mesh, error, "golf.stl").size(), 100u);
}

TEST(ConvexParts, RefusesASurfaceThatCrossesItself) {
  TriangleMesh mesh = blocks({{0, 0, 0}, {1, 0, 0}, {0, 0, 1}});
  for (Vec3& v : mesh.vertices)
    if (v == Vec3(2, 0, 0)) v = Vec3(-1, 0.5, 0.5);
  try {
    make_mesh(mesh, "angle.stl");
    ADD_FAILURE() << "accepted";
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("the surface crosses itself: triangles"));
  }
}

}  // namespace
}  // namespace ejecta
