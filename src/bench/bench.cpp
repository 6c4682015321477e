#include "bench/bench.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/parallel.hpp"
#include "base/stopwatch.hpp"
#include "bench/bench_dem.hpp"
#include "bench/bench_grains.hpp"
#include "bench/bench_jet.hpp"
#include "case/load.hpp"
#include "simulation/coupled_model.hpp"

namespace ejecta {
namespace {

/// The paper's box and particle at full blow, small enough to carry along: 84 x 80 x 85 cells, k-epsilon, a
/// 27-sphere cube on the axis of a jet that is already open.
constexpr const char* kStandardCase = R"(
[run]
title = "standard case of ejecta bench"
end_time = "100 ms"
[flow]
turbulence = "k-epsilon"
[grid.x]
points = ["-42 mm", "-16.875 mm", "16.875 mm", "42 mm"]
cells = [15, 54, 15]
grading = [0.1822, 1, 5.489]
[grid.y]
points = ["-40 mm", "-12 mm", "12 mm", "40 mm"]
cells = [20, 40, 20]
grading = [0.2246, 1, 4.452]
[grid.z]
points = ["40 mm", "64 mm", "92 mm", "125 mm"]
cells = [22, 45, 18]
grading = [0.3557, 1, 6.404]
[boundary.x_min]
type = "free-stream"
[boundary.x_max]
type = "free-stream"
[boundary.y_min]
type = "free-stream"
[boundary.y_max]
type = "free-stream"
[boundary.z_min]
type = "jet"
[boundary.z_max]
type = "pressure-outlet"
[valve]
supply_pressure = "700 kPa gauge"
rise_time = "0.1 ms"
duration = "90 ms"
[[material]]
name = "ore"
[[body]]
name = "particle"
shape = "cluster"
size = ["10 mm", "10 mm", "10 mm"]
cluster = [3, 3, 3]
sphere_diameter = "5 mm"
true_box_mass = true
material = "ore"
position = ["0 mm", "0 mm", "75 mm"]
velocity = ["3 m/s", "0 m/s", "0 m/s"]
)";

/// Bytes a second that all threads together copy through memory (read + write), best of five.
double copy_bandwidth() {
  const std::size_t n = std::size_t(1) << 25;  // 128 MiB of floats: larger than any cache
  std::vector<float> from(n, 1.0f), to(n);
  double best = 0.0;
  for (int repeat = 0; repeat < 5; ++repeat) {
    const double start = wall_seconds();
    for_each_chunk(static_cast<int>(n >> 10), [&](int c0, int c1) {
      std::copy(from.begin() + (std::ptrdiff_t(c0) << 10), from.begin() + (std::ptrdiff_t(c1) << 10),
                to.begin() + (std::ptrdiff_t(c0) << 10));
    });
    best = std::max(best, 2.0 * sizeof(float) * double(n) / (wall_seconds() - start));
  }
  return best;
}

/// Real numbers an operator must at least read and write per cell and step, counting every field once a pass:
/// with the bandwidth this is the time below which it cannot go unless fields stay in cache between passes.
double least_traffic(const std::string& name) {
  if (name == "flow.momentum_predictor")
    return 2 * (3 + 3 + 1 + 1 + 3 + 3);                                // u, q, p, nu_t, old; u*; two stages
  if (name == "flow.face_velocities") return 2 * (3 + 1 + 3 + 3 + 1);  // u*, p -> q; q -> rhs
  if (name == "flow.pressure") return 2 * (2 + 3 + 2);                 // forward, two-way sweep, backward
  if (name == "flow.correction") return 2 * (3 * (1 + 4) + 3);         // phi, q, u read and written; p
  if (name == "flow.turbulence") return 2 + 3 + 3 + 1 + 3;  // k, epsilon, u, q, nu_t; three written
  return 0.0;
}

}  // namespace

void bench(const BenchOptions& options, const Note& tell) {
  if (options.threads > 0) set_thread_count(options.threads);
  if (!options.only.empty() && options.only != "flow") {
    if (options.only == "grains") bench_grains(kStandardCase, options.steps, tell);
    else bench_dem(options.only == "settled", tell);
    return;
  }
  const Case c = parse_case(kStandardCase, "the standard case");
  CoupledModel model(c);
  double time = 0.0;
  const auto step = [&] {
    const double dt = model.stable_dt(time);
    model.advance(time, dt);
    time += dt;
  };
  for (int n = 0; n < 20; ++n) step();
  const auto before = model.operator_times();
  std::vector<double> seconds;
  for (int n = 0; n < options.steps; ++n) {
    const double start = wall_seconds();
    step();
    seconds.push_back(wall_seconds() - start);
  }
  const auto after = model.operator_times();
  std::sort(seconds.begin(), seconds.end());
  const double median = seconds[seconds.size() / 2], cells = double(model.grid().cells());
  const double bandwidth = copy_bandwidth();
  tell(fmt::format("standard case: {} cells, k-epsilon, one 27-sphere body; {} threads, {} steps after 20",
                   model.grid().cells(), thread_count(), options.steps));
  tell(fmt::format("median step {:.2f} ms: {:.1f} million cell-steps/s (fastest {:.1f}, slowest {:.1f})",
                   median * 1e3, cells / median * 1e-6, cells / seconds.front() * 1e-6,
                   cells / seconds.back() * 1e-6));
  tell(fmt::format("memory copies {:.1f} GB/s\n\n{:<28}{:>10}{:>8}{:>16}", bandwidth * 1e-9, "operator",
                   "ms/step", "%", "% of the limit"));
  for (std::size_t n = 0; n < after.size(); ++n) {
    const double mean = (after[n].seconds - before[n].seconds) / options.steps;
    const double limit = least_traffic(after[n].name) * cells * sizeof(Real) / bandwidth;
    tell(fmt::format(
        "{:<28}{:>10.3f}{:>8.1f}{:>16}", after[n].name, mean * 1e3, 100.0 * mean / median,
        limit > 0.0 ? fmt::format("{:.0f}", 100.0 * limit / std::max(mean, 1e-12)) : std::string()));
  }
  tell(
      "\nThe limit is the time memory needs to deliver every field of a pass once; above 100 % fields stayed "
      "in cache.");
  if (options.only == "flow") return;
  bench_jet(options.steps, tell);
  bench_dem(false, tell);
  bench_grains(kStandardCase, options.steps, tell);
}

}  // namespace ejecta
