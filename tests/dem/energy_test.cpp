#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>
#include <sstream>

#include "surface_scenes.hpp"

/// Energy comes from nowhere: a body that drops on, slides over or is pushed through any surface.
namespace ejecta {
namespace {

constexpr double kSize = 10e-3;    // m
constexpr double kAllowed = 0.02;  // of the energy there was: round-off of finite steps

/// A scene as numbers in [0, 1]: what fails is made simpler by making them smaller.
using Draw = std::vector<double>;
constexpr std::size_t kNumbers = 26;

struct Shapes {
  std::vector<std::pair<const char*, Shape>> all;
  Shapes() {
    TriangleMesh ico = icosphere(1);
    for (Vec3& v : ico.vertices) v *= 0.5 * kSize;
    all = {{"sphere", make_sphere(kSize)},
           {"box", make_box(kSize * Vec3(1, 0.8, 0.6))},
           {"cluster", make_cluster(Vec3::Constant(kSize), {3, 3, 3}, 0.5 * kSize)},
           {"plate", make_box(kSize * Vec3(1, 1, 0.1))},
           {"superquadric", make_superquadric(kSize * Vec3(1, 0.8, 0.6), 2, 2)},
           {"mesh", make_mesh(ico, "ico")},
           {"table", make_mesh(table_mesh(2, kSize), "table")},
           {"small sphere", make_sphere(0.2 * kSize)}};
  }
};

struct Surfaces {
  std::vector<std::pair<const char*, TriangleMesh>> all;
  Surfaces() {
    TriangleMesh roof = flat_mesh(6, 30e-3), hollow = roof, bowl = flat_mesh(20, 30e-3);
    for (Vec3& v : roof.vertices) v.z() = -0.5 * std::abs(v.x());
    for (Vec3& v : hollow.vertices) v.z() = 0.5 * std::abs(v.x());
    for (Vec3& v : bowl.vertices) v.z() = 10.0 * (v.x() * v.x() + v.y() * v.y());
    all = {
        {"flat, 1", flat_mesh(1, 30e-3)},
        {"flat, 12", flat_mesh(12, 30e-3)},
        {"block", moved(block_mesh(Vec3(15e-3, 12e-3, 10e-3), 3), Mat3::Identity(), Vec3(0, 0, -10e-3))},
        {"sheet", moved(block_mesh(Vec3(30e-3, 30e-3, 0.25e-3), 4), Mat3::Identity(), Vec3(0, 0, -0.25e-3))},
        {"roof", roof},
        {"hollow", hollow},
        {"bowl", bowl},
        {"table", moved(table_mesh(3, 40e-3), Mat3::Identity(), Vec3(0, 0, -16e-3))}};
  }
};

std::size_t pick(double u, std::size_t count) {
  return std::min(count - 1, static_cast<std::size_t>(u * static_cast<double>(count)));
}

Quat turn_of(const Draw& u, std::size_t first) {
  const Vec3 axis(u[first] - 0.5, u[first + 1] - 0.5, u[first + 2] - 0.5);
  return axis.norm() > 1e-9 ? Quat(Eigen::AngleAxisd(2 * M_PI * u[first + 3], axis.normalized()))
                            : Quat::Identity();
}

struct Outcome {
  double gain = 0.0;  // of the energy there was
  std::string scene;
};

Outcome outcome(const Draw& u) {
  static const Shapes shapes;
  static const Surfaces surfaces;
  MaterialSpec m = stone();
  m.restitution = 0.05 + 0.95 * u[0];
  m.friction = u[1];
  m.rolling_friction = u[2] < 0.5 ? 0.0 : 0.2 * (u[2] - 0.5);
  const Case c = scene(m);
  const Materials materials(c);
  const Vec3 gravity(0, 0, u[3] < 0.3 ? 0.0 : -9.81);
  Particles p(gravity, materials, c.contact);
  std::ostringstream what;
  const bool convex = u[4] < 0.5;  // walls of the case file, or triangles
  const Mat3 tilt =
      u[5] < 0.5 ? Mat3(Mat3::Identity()) : turn_of({0, u[6], 0.5 + u[6], 0.1 * u[7]}, 0).toRotationMatrix();
  if (convex) {
    WallSpec w = floor_at(0);
    const std::size_t kind = pick(u[8], 3);
    w.kind = kind == 0 ? WallKind::plane : kind == 1 ? WallKind::box : WallKind::plate;
    w.normal = tilt * Vec3(0, 0, 1);
    w.size = kind == 2 ? Vec3(40e-3, 40e-3, 1e-3) : Vec3(30e-3, 40e-3, 20e-3);
    if (kind == 1) w.point.z() = -10e-3;
    p.add(make_wall(w, materials, ""));
    what << (kind == 0 ? "plane" : kind == 1 ? "box" : "plate");
  } else {
    const auto& [name, mesh] = surfaces.all[pick(u[8], surfaces.all.size())];
    p.add(wall_of(moved(mesh, tilt, Vec3(0, 0, 0)), u[9] < 0.5));
    what << name << (u[9] < 0.5 ? ", two sides" : "");
  }
  const int count = u[10] < 0.6 ? 1 : 2;
  double speed = 3.0 * u[11];
  for (int n = 0; n < count; ++n) {
    const auto& [name, shape] = shapes.all[pick(u[n == 0 ? 12 : 13], shapes.all.size())];
    Body b = body_of(name, shape, materials);
    b.orientation = turn_of(u, n == 0 ? 14 : 15) * b.orientation;
    const double side = u[19] < 0.15 && !p.walls()[0].is_plane ? -1.0 : 1.0;  // from behind
    b.position =
        Vec3(40e-3 * (u[20] - 0.5), 40e-3 * (u[21] - 0.5), 0) + Vec3(0, 0, side * (25e-3 + 22e-3 * n));
    b.velocity = Vec3(2 * (u[22] - 0.5), 2 * (u[23] - 0.5), -side * (0.1 + speed));
    b.angular_velocity = 50.0 * Vec3(u[24] - 0.5, u[22] - 0.5, u[23] - 0.5);
    p.add(b);
    what << " | " << name;
  }
  // Some are pushed: what the push gives is no gain.
  std::vector<Load> loads(static_cast<std::size_t>(count));
  if (u[25] > 0.6)
    for (Load& load : loads) load.force = Vec3(0, 0, -2.0 * (u[25] - 0.6));
  what << " | e " << m.restitution << ", mu " << m.friction << ", push " << loads[0].force.z() << " N";
  const auto energy = [&] {
    const DemEnergy e = p.energy();
    return e.kinetic + e.potential - e.work;
  };
  const double before = energy();
  double moving = p.energy().kinetic, worst = 0.0;
  for (int n = 0; n < 60; ++n) {
    p.advance(1e-3, loads);
    const DemEnergy e = p.energy();
    moving = std::max(moving, p.energy().kinetic);
    worst = std::max(worst, (e.kinetic + e.potential - e.work - before) / moving);
  }
  return {worst, what.str()};
}

/// The simplest scene that still fails: every number made nothing, or half, as long as it does.
Draw shrunk(Draw u) {
  for (bool simpler = true; simpler;) {
    simpler = false;
    for (double& v : u)
      for (const double factor : {0.0, 0.5}) {
        const double old = v;
        if (old < 1e-3) continue;
        v *= factor;
        if (outcome(u).gain > kAllowed) {
          simpler = true;
          break;
        }
        v = old;
      }
  }
  return u;
}

/// A few; with EJECTA_ENERGY_SCENES as many as asked for (label slow: 10,000).
TEST(Energy, ComesFromNowhere) {
  const char* asked = std::getenv("EJECTA_ENERGY_SCENES");
  const int scenes = asked ? std::atoi(asked) : 40;
  int wrong = 0;
  for (int n = 0; n < scenes && wrong < 3; ++n) {
    std::mt19937_64 random(static_cast<std::uint64_t>(n));
    std::uniform_real_distribution<double> uniform(0, 1);
    Draw u(kNumbers);
    for (double& v : u) v = uniform(random);
    const Outcome o = outcome(u);
    if (!(o.gain > kAllowed)) continue;
    ++wrong;
    const Outcome least = outcome(shrunk(u));
    ADD_FAILURE() << "scene " << n << " gains " << 100 * o.gain << " %: " << o.scene
                  << "\n  as simple as it gets (" << 100 * least.gain << " %): " << least.scene;
  }
}

}  // namespace
}  // namespace ejecta
