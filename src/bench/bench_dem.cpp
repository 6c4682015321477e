#include "bench/bench_dem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "base/parallel.hpp"
#include "base/stopwatch.hpp"
#include "dem/particles.hpp"

namespace ejecta {
namespace {

constexpr double kRadius = 5e-3, kStep = 5e-5;  // m, s: the paper's softened quartz

/// Fraction of n times an irrational number: scatter that any program can repeat.
double scatter(int n, double irrational) { return n * irrational - std::floor(n * irrational); }

Particles empty_scene(const std::vector<std::pair<Vec3, Vec3>>& planes, const Vec3& floor_velocity) {
  Case c;
  MaterialSpec stone;
  stone.name = "stone";
  c.materials = {stone};
  c.contact.time_step = kStep;
  Particles p(c.environment.gravity, Materials(c), c.contact);
  for (const auto& [normal, point] : planes) {
    WallSpec wall;
    wall.name = "wall";
    wall.normal = normal;
    wall.point = point;
    if (normal.z() > 0) wall.velocity = floor_velocity;
    p.add(make_wall(wall, p.materials(), ""));
  }
  return p;
}

/// `count` bodies on a lattice of `side` x `side` columns in an open box, a little off their places.
template <class Make>
Particles box_of(int count, int side, double pitch, const Vec3& floor_velocity, const Make& make) {
  const double width = side * pitch;
  Particles p = empty_scene({{Vec3(0, 0, 1), Vec3(0, 0, 0)},
                             {Vec3(1, 0, 0), Vec3(0, 0, 0)},
                             {Vec3(-1, 0, 0), Vec3(width, 0, 0)},
                             {Vec3(0, 1, 0), Vec3(0, 0, 0)},
                             {Vec3(0, -1, 0), Vec3(0, width, 0)}},
                            floor_velocity);
  for (int n = 0; n < count; ++n) {
    BodySpec body = make(n);
    const Vec3 off(scatter(n, 0.6180339887), scatter(n, 0.7548776662), scatter(n, 0.5698402910));
    body.position = pitch * Vec3(n % side + 0.5, n / side % side + 0.5, n / (side * side) + 0.5) +
                    0.04 * kRadius * (off - Vec3::Constant(0.5));
    p.add(make_body(body, p.materials(), ""));
  }
  return p;
}

Particles spheres(int count, double pitch) {
  const int side = std::max(4, static_cast<int>(std::lround(std::cbrt(count))));
  return box_of(count, side, pitch * kRadius, Vec3(0, 0, 0), [](int) {
    BodySpec body;
    body.diameter = 2 * kRadius;
    return body;
  });
}

/// Boxes, icosahedra and tetrahedra of equal reach, four layers that fall onto a belt at 3 m/s.
Particles belt(int count) {
  const int side = std::max(4, static_cast<int>(std::lround(std::sqrt(count / 4.0))));
  return box_of(count, side, 2.1 * kRadius, Vec3(3, 0, 0), [](int n) {
    BodySpec body;
    body.shape = ShapeKind::polyhedron;
    if (n % 3 == 0) {
      body.shape = ShapeKind::box;
      body.size = Vec3::Constant(2 * kRadius / std::sqrt(3.0));
    } else if (n % 3 == 1) {
      for (const Vec3& v : icosphere(0).vertices) body.vertices.push_back(kRadius * v);
    } else {
      for (const Vec3& v : {Vec3(1, 1, 1), Vec3(1, -1, -1), Vec3(-1, 1, -1), Vec3(-1, -1, 1)})
        body.vertices.push_back(kRadius / std::sqrt(3.0) * v);
    }
    return body;
  });
}

enum class BenchFloor { plane, triangles, waves };

/// 200 bodies on a plane, on 20,000 triangles of 6 mm that lie in it, or in their waves.
Particles on_floor(BenchFloor floor_kind, ShapeKind kind) {
  constexpr int kCells = 100, kSide = 14;
  constexpr double kWidth = 0.6;  // m
  Particles p = empty_scene({}, Vec3(0, 0, 0));
  const auto height = [&](double x, double y) {
    return floor_kind == BenchFloor::waves ? 5e-3 * (std::sin(40 * x) + std::sin(40 * y)) : 0.0;
  };
  Wall floor;
  if (floor_kind != BenchFloor::plane) {
    TriangleMesh mesh;
    for (int j = 0; j <= kCells; ++j)
      for (int i = 0; i <= kCells; ++i) {
        const double x = kWidth * (double(i) / kCells - 0.5), y = kWidth * (double(j) / kCells - 0.5);
        mesh.vertices.push_back(Vec3(x, y, height(x, y)));
      }
    const auto at = [](int i, int j) { return j * (kCells + 1) + i; };
    for (int j = 0; j < kCells; ++j)
      for (int i = 0; i < kCells; ++i) {
        mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
        mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
      }
    floor.name = "triangles";
    floor.is_plane = false;
    floor.surface = std::make_shared<Surface>(mesh);
  } else {
    WallSpec wall;
    wall.name = "plane";
    floor = make_wall(wall, p.materials(), "");
  }
  p.add(std::move(floor));
  for (int n = 0; n < 200; ++n) {
    BodySpec body;
    body.shape = kind;
    body.diameter = 2 * kRadius;
    body.size = Vec3::Constant(2 * kRadius);
    const double pitch = 0.9 * kWidth / kSide, x = pitch * (n % kSide + 0.5) - 0.45 * kWidth,
                 y = pitch * (n / kSide % kSide + 0.5) - 0.45 * kWidth;
    body.position = Vec3(x, y, height(x, y) + (2 + 3 * (n / (kSide * kSide))) * kRadius);
    p.add(make_body(body, p.materials(), ""));
  }
  return p;
}

/// Lets the bodies move, then tells one line.
void measure(const char* name, Particles p, int settle, int steps, const Note& tell) {
  p.advance(settle * kStep);
  const double count = static_cast<double>(p.bodies().size());
  constexpr int kParts = 10;
  std::vector<double> seconds;
  const DemTimes before = p.times();
  const std::int64_t lists = p.lists();
  double contacts = 0.0;
  for (int n = 0; n < kParts; ++n) {
    const double start = wall_seconds();
    p.advance(steps / kParts * kStep);
    seconds.push_back((wall_seconds() - start) / (steps / kParts));
    contacts += static_cast<double>(p.contacts().size()) / kParts;
  }
  std::sort(seconds.begin(), seconds.end());
  const double step = seconds[kParts / 2];
  const DemTimes t = p.times();
  const double parts[] = {t.listing - before.listing, t.balls - before.balls, t.solids - before.solids,
                          t.motion - before.motion};
  const double all = parts[0] + parts[1] + parts[2] + parts[3];
  tell(fmt::format("{:<38}{:>9.3f}{:>10.2f}{:>10.0f}{:>9.0f}{:>8.0f}{:>8.0f}{:>8.0f}{:>8.0f}{:>8.1f}", name,
                   step * 1e3, count / step * 1e-6 / thread_count(), contacts,
                   step * thread_count() / std::max(contacts, 1.0) * 1e9, 100 * parts[1] / all,
                   100 * parts[2] / all, 100 * parts[3] / all, 100 * parts[0] / all,
                   double(steps) / std::max<double>(1.0, static_cast<double>(p.lists() - lists))));
}

}  // namespace

void bench_dem(bool only_settled, const Note& tell) {
  tell(fmt::format("\nbodies that touch ({} threads; median of ten parts)", thread_count()));
  tell(fmt::format("{:<38}{:>9}{:>10}{:>10}{:>9}{:>8}{:>8}{:>8}{:>8}{:>8}", "", "ms/step", "M p-s/s/c",
                   "contacts", "ns/cont.", "balls %", "solids", "motion", "lists", "steps/l."));
  measure("10,000 spheres settled", spheres(10000, 2.1), 4000, 2000, tell);
  if (only_settled) return;
  measure("10,000 spheres settling", spheres(10000, 2.1), 0, 4000, tell);
  measure("2,000 polyhedra on a belt", belt(2000), 800, 400, tell);
  for (const BenchFloor kind : {BenchFloor::plane, BenchFloor::triangles, BenchFloor::waves}) {
    const char* floor = kind == BenchFloor::plane       ? "a plane"
                        : kind == BenchFloor::triangles ? "20,000 flat triangles"
                                                        : "20,000 triangles in waves";
    measure(fmt::format("200 balls on {}", floor).c_str(), on_floor(kind, ShapeKind::sphere), 2000, 2000,
            tell);
    measure(fmt::format("200 boxes on {}", floor).c_str(), on_floor(kind, ShapeKind::box), 1000, 500, tell);
  }
  for (const int count : {1000, 10000, 30000, 100000, 300000})
    measure(fmt::format("{} spheres in contact", count).c_str(), spheres(count, 2.0), 200, 200, tell);
  tell("M p-s/s/c: million particle-steps a second and core; steps/l.: steps between lists of neighbours");
}

}  // namespace ejecta
