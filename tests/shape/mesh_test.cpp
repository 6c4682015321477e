#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cctype>
#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>

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

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

std::string refusal_of(const std::string& bytes) {
  try {
    parse_stl(bytes, 1.0, "x.stl");
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

/// However a text is divided into lines and spelt, it is the same surface.
TEST(Stl, WritersDifferInWhatDoesNotMatter) {
  const std::string text = text_stl(cube());
  const TriangleMesh right = parse_stl(text, 1.0, "x");
  std::string capitals = text;
  for (char& c : capitals) c = static_cast<char>(std::toupper(c));
  for (const std::string& same :
       {capitals, "\xEF\xBB\xBF" + text, "\n  " + text, replaced(text, "\n", "\r\n"),
        replaced(text, "\n", " \n\n\t"), replaced(text, "vertex ", "vertex\n"),
        replaced(replaced(text, "\n", " "), "endsolid", "\nendsolid"), text + "\n\n",
        text + std::string(3, '\0'), text + "\x1a", replaced(text, " 0.500000", " +5.0D-01"),
        replaced(text, " 0.500000", " 50.d-2"),
        "solid" + text.substr(text.find('\n')).substr(0, text.rfind("endsolid") - text.find('\n')) +
            "endsolid"}) {
    const TriangleMesh mesh = parse_stl(same, 1.0, "x");
    EXPECT_EQ(mesh.triangles, right.triangles) << same.substr(0, 200);
    for (std::size_t n = 0; n < mesh.vertices.size(); ++n) EXPECT_EQ(mesh.vertices[n], right.vertices[n]);
  }
}

/// What is cut, lost or meant otherwise is refused with its line: never another surface in silence.
TEST(Stl, WhatIsCutOrMeantOtherwiseIsRefusedWithItsLine) {
  const std::string text = text_stl(cube());
  for (std::size_t length = 1; length + 9 < text.size(); ++length)  // "endsolid" may lack its name
    EXPECT_NE(refusal_of(text.substr(0, length)), "") << length;
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  for (std::size_t lost = 0; lost < lines.size(); ++lost) {
    std::string less;
    for (std::size_t n = 0; n < lines.size(); ++n)
      if (n != lost) less += lines[n] + "\n";
    EXPECT_NE(refusal_of(less), "") << "without line " << lost + 1;
  }
  EXPECT_THAT(refusal_of(replaced(text, "0.500000", "0,500000")), HasSubstr("has a decimal comma"));
  EXPECT_THAT(refusal_of(replaced(text, " 0.500000", " 0.500000;")), HasSubstr("x.stl:"));
  EXPECT_THAT(refusal_of(text + "and more\n"), HasSubstr("expected \"solid\", found \"and\""));
  const std::string binary = binary_stl(cube());
  EXPECT_THAT(refusal_of(binary + "more"), HasSubstr("are no part of it"));
  EXPECT_THAT(refusal_of(binary.substr(0, binary.size() - 1)), HasSubstr("cut short"));
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
