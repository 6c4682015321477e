#include <benchmark/benchmark.h>

#include <cmath>
#include <random>

#include "base/parallel.hpp"
#include "dem/particles.hpp"

/// Spheres of 10 mm of the paper's material in a box: falling, and settled. `items_per_second` is
/// particle-steps/s.
namespace ejecta {
namespace {

constexpr double kRadius = 5e-3, kStep = 5e-5;  // m, s

Particles heap(int count, bool rocks) {
  Case c;
  MaterialSpec stone;
  stone.name = "stone";
  c.materials = {stone};
  c.contact.time_step = kStep;
  Particles p(c.environment.gravity, Materials(c), c.contact);
  const int side = std::max(4, static_cast<int>(std::lround(std::cbrt(count))));
  const double pitch = 2.1 * kRadius, width = side * pitch;
  WallSpec wall;
  wall.name = "wall";
  const std::pair<Vec3, Vec3> planes[] = {{Vec3(0, 0, 1), Vec3(0, 0, 0)},
                                          {Vec3(1, 0, 0), Vec3(0, 0, 0)},
                                          {Vec3(-1, 0, 0), Vec3(width, 0, 0)},
                                          {Vec3(0, 1, 0), Vec3(0, 0, 0)},
                                          {Vec3(0, -1, 0), Vec3(0, width, 0)}};
  for (const auto& [normal, point] : planes) {
    wall.normal = normal;
    wall.point = point;
    p.add(make_wall(wall, p.materials(), ""));
  }
  std::mt19937 random(1);
  std::uniform_real_distribution<double> jitter(-0.02 * kRadius, 0.02 * kRadius);
  BodySpec body;
  body.diameter = 2 * kRadius;
  const double s = kRadius / std::sqrt(3.0);
  for (int n = 0; n < count; ++n) {
    if (rocks && n % 2 == 0) {
      body.shape = ShapeKind::box;
      body.size = Vec3::Constant(2 * s);
    } else if (rocks) {
      body.shape = ShapeKind::polyhedron;
      body.vertices.clear();
      for (const Vec3& v : icosphere(0).vertices) body.vertices.push_back(kRadius * v);
    }
    body.position = pitch * Vec3(n % side + 0.5, n / side % side + 0.5, n / (side * side) + 0.5) +
                    Vec3(jitter(random), jitter(random), jitter(random));
    p.add(make_body(body, p.materials(), ""));
  }
  return p;
}

void run(benchmark::State& state, bool rocks, int settle) {
  const int count = static_cast<int>(state.range(0)), steps = rocks ? 20 : 100;
  set_thread_count(1);
  Particles p = heap(count, rocks);
  p.advance(settle * kStep);
  for (auto _ : state) p.advance(steps * kStep);
  state.SetItemsProcessed(state.iterations() * steps * count);
  state.counters["contacts"] = static_cast<double>(p.contacts().size());
}

void spheres_settled(benchmark::State& state) { run(state, false, 4000); }
void spheres_falling(benchmark::State& state) { run(state, false, 0); }
void polyhedra_falling(benchmark::State& state) { run(state, true, 0); }

BENCHMARK(spheres_falling)->Arg(1000)->Arg(10000)->Arg(100000)->Unit(benchmark::kMillisecond);
BENCHMARK(spheres_settled)->Arg(1000)->Arg(10000)->Unit(benchmark::kMillisecond);
BENCHMARK(polyhedra_falling)->Arg(2000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace ejecta

BENCHMARK_MAIN();
