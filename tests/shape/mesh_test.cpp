#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "base/error.hpp"
#include "shape/shape.hpp"
#include "shape/stl.hpp"

namespace ejecta {
namespace {

using testing::HasSubstr;

std::string text_stl(const TriangleMesh& mesh) {
  std::string s = "solid test\n";
  for (const auto& t : mesh.triangles) {
    s += "facet normal 0 0 0\n outer loop\n";
    for (const int c : t) {
      const Vec3& p = mesh.vertices[static_cast<std::size_t>(c)];
      s += "  vertex " + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " + std::to_string(p.z()) +
           "\n";
    }
    s += " endloop\nendfacet\n";
  }
  return s + "endsolid test\n";
}

std::string binary_stl(const TriangleMesh& mesh) {
  std::string s(80, 's');
  const auto put = [&](const auto& v) { s.append(reinterpret_cast<const char*>(&v), sizeof v); };
  put(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& t : mesh.triangles) {
    for (int n = 0; n < 3; ++n) put(0.0f);
    for (const int c : t)
      for (int k = 0; k < 3; ++k) put(static_cast<float>(mesh.vertices[static_cast<std::size_t>(c)][k]));
    put(static_cast<std::uint16_t>(0));
  }
  return s;
}

TriangleMesh cube() { return make_box(Vec3(1, 1, 1)).surface(); }

std::string error_of(const TriangleMesh& mesh) {
  try {
    make_mesh(mesh, "lump.stl");
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

TEST(Stl, TextAndBinaryGiveTheSameSolid) {
  for (const std::string& bytes : {text_stl(cube()), binary_stl(cube())}) {
    const TriangleMesh mesh = parse_stl(bytes, 1e-3, "cube");
    EXPECT_EQ(mesh.vertices.size(), 8u);
    EXPECT_EQ(mesh.triangles.size(), 12u);
    EXPECT_NEAR(make_mesh(mesh, "cube").mass_properties().volume, 1e-9, 1e-21);
  }
}

TEST(Stl, RefusesWhatIsBroken) {
  EXPECT_THROW(parse_stl("", 1, "x"), InputError);
  EXPECT_THROW(parse_stl("solid nothing\nendsolid", 1, "x"), InputError);
  EXPECT_THROW(parse_stl("solid a\nvertex 0 0\n", 1, "x"), InputError);
  EXPECT_THROW(parse_stl(binary_stl(cube()).substr(0, 300), 1, "x"), InputError);
  TriangleMesh bad = cube();
  bad.vertices[3].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(parse_stl(binary_stl(bad), 1, "x"), InputError);
}

TEST(Mesh, NamesTheOpenEdge) {
  TriangleMesh mesh = cube();
  mesh.triangles.pop_back();
  EXPECT_THAT(error_of(mesh), HasSubstr("open"));
  EXPECT_THAT(error_of(mesh), HasSubstr("the edge (")) << error_of(mesh);
}

TEST(Mesh, NamesTheInvertedTriangle) {
  TriangleMesh mesh = cube();
  std::swap(mesh.triangles[4][0], mesh.triangles[4][1]);
  EXPECT_THAT(error_of(mesh), HasSubstr("inside out"));
  for (auto& t : mesh.triangles) std::swap(t[0], t[1]);
  std::swap(mesh.triangles[4][0], mesh.triangles[4][1]);
  EXPECT_THAT(error_of(mesh), HasSubstr("its normals point inwards"));
}

TEST(Mesh, NamesTheDegenerateTriangle) {
  TriangleMesh mesh = cube();
  mesh.triangles.push_back({0, 1, 1});
  EXPECT_THAT(error_of(mesh), HasSubstr("triangle 13 is degenerate"));
}

/// A dent is divided away, exactly.
TEST(Mesh, ADentedSphere) {
  TriangleMesh mesh = icosphere(1);
  mesh.vertices[5] *= 0.5;
  const Shape s = make_mesh(mesh, "dented");
  EXPECT_GT(s.polytopes().size(), 1u);
  EXPECT_NEAR(s.parts_volume(), mass_mesh(mesh).volume, 1e-9);
}

TEST(Mesh, TwoConvexPiecesMakeOneSolid) {
  TriangleMesh mesh = cube(), other = cube();
  for (const Vec3& v : other.vertices) mesh.vertices.push_back(v + Vec3(1.5, 0, 0));
  for (const auto& t : other.triangles) mesh.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  const Shape s = make_mesh(mesh, "pair");
  EXPECT_EQ(s.polytopes().size(), 2u);
  EXPECT_NEAR(s.mass_properties().volume, 2.0, 1e-12);
  EXPECT_NEAR(s.signed_distance(Vec3(0, 0, 0)), 0.25, 1e-12);  // in the gap
}

}  // namespace
}  // namespace ejecta
