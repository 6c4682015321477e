#include "dem/walls.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/error.hpp"
#include "scene.hpp"
#include "surface_scenes.hpp"

namespace ejecta {
namespace {

/// A floor of 2 n n triangles over [-s, s]^2 with a ridge or hollow of slope `slope` along y.
TriangleMesh floor_mesh(int n, double s, double slope) {
  TriangleMesh mesh = flat_mesh(n, s);
  for (Vec3& v : mesh.vertices) v.z() = -slope * std::abs(v.x());
  return mesh;
}

std::string write_stl(const std::string& name, const TriangleMesh& mesh) {
  const std::string path = (std::filesystem::temp_directory_path() / name).string();
  std::ofstream out(path);
  out << "solid wall\n";
  for (const auto& t : mesh.triangles) {
    out << "facet normal 0 0 0\nouter loop\n";
    for (const int c : t) out << "vertex " << mesh.vertices[static_cast<std::size_t>(c)].transpose() << "\n";
    out << "endloop\nendfacet\n";
  }
  out << "endsolid wall\n";
  return path;
}

Case on_mesh(const std::string& path) {
  MaterialSpec m = stone();
  m.friction = 0.0;
  Case c = scene(m);
  c.environment.gravity = Vec3(0, 0, -9.81);
  WallSpec w;
  w.name = "chute";
  w.kind = WallKind::mesh;
  w.material = "stone";
  w.file = path;
  c.walls = {w};
  return c;
}

/// However a flat wall is divided, balls and boxes slide over it as over a plane.
TEST(MeshWall, DividedFloorIsAsSmoothAsAPlane) {
  const std::string path = write_stl("ejecta_floor.stl", floor_mesh(8, 0.1, 0.0));
  for (const bool round : {true, false}) {
    Case c = on_mesh(path);
    const Vec3 at(-0.05, 0.003, 5e-3), v(0.5, 0.1, 0);
    c.bodies = {round ? ball("body", 10e-3, at, v) : box("body", Vec3::Constant(10e-3), at, v)};
    Particles p = make_particles(c);
    c.walls = {floor_at(0)};
    Particles q = make_particles(c);
    for (int n = 0; n < 15; ++n) {
      p.advance(0.01);
      q.advance(0.01);
      EXPECT_NEAR((p.bodies()[0].position - q.bodies()[0].position).norm(), 0, 2e-7) << n;
      EXPECT_NEAR(p.bodies()[0].velocity.x(), 0.5, 1e-4);
    }
  }
}

TEST(MeshWall, RidgeCarriesABallOnceAndHollowTwice) {
  const double slope = 0.3, weight = 2700 * M_PI / 6 * 1e-6 * 9.81;
  for (const double sign : {1.0, -1.0}) {
    Case c = on_mesh(write_stl("ejecta_ridge.stl", floor_mesh(8, 0.1, sign * slope)));
    const double rest = sign > 0 ? 5e-3 : 5e-3 * std::sqrt(1 + slope * slope);
    c.bodies = {ball("ball", 10e-3, Vec3(0, 0.01, rest))};
    Particles p = make_particles(c);
    p.advance(0.2);
    EXPECT_EQ(p.contacts().size(), sign > 0 ? 1u : 2u);
    EXPECT_NEAR(p.contact_force(0).z(), weight, 1e-3 * weight);
    EXPECT_NEAR(p.bodies()[0].position.x(), 0, 1e-6);
  }
}

TEST(MeshWall, MissingFileNamesTheWall) {
  const Case c = on_mesh("/nowhere/chute.stl");
  EXPECT_THROW(make_particles(c), InputError);
}

}  // namespace
}  // namespace ejecta
