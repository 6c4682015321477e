#include "bench/bench_jet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "base/parallel.hpp"
#include "base/stopwatch.hpp"
#include "case/load.hpp"
#include "jet/model.hpp"

namespace ejecta {
namespace {

/// cases/paper/jet-700kPa.toml with a valve that is open at once.
constexpr const char* kJetCase = R"(
[run]
title = "standard jet of ejecta bench"
end_time = "100 ms"
courant = 0.9
[flow]
solver = "compressible"
turbulence = "k-epsilon"
[valve]
supply_pressure = "700 kPa gauge"
orifice_diameter = "1.8 mm"
rise_time = "0.05 ms"
duration = "90 ms"
[grid]
geometry = "axisymmetric"
[grid.x]
points = ["0 mm", "0.9 mm", "1.8 mm", "70 mm"]
cells = [8, 8, 54]
grading = [1, 1, 42.3]
[grid.y]
points = ["0 mm", "1 mm"]
cells = [1]
[grid.z]
points = ["0 mm", "9 mm", "150 mm"]
cells = [60, 140]
grading = [1, 20]
[boundary.x_max]
type = "free-stream"
[boundary.y_min]
type = "symmetry"
[boundary.y_max]
type = "symmetry"
[boundary.z_min]
type = "wall"
[[boundary.z_min.patch]]
type = "jet"
centre = ["0 mm", "0 mm", "0 mm"]
radius = "0.9 mm"
[boundary.z_max]
type = "wave-transmissive"
)";

/// Steps timed together: one alone is too short for the clock.
constexpr int kTogether = 20;

}  // namespace

void bench_jet(int steps, const Note& tell) {
  JetModel jet(parse_case(kJetCase, "the standard jet"));
  Clock clock = jet.clock();
  for (int n = 0; n < 20 * kTogether; ++n) jet.step(clock);
  std::vector<double> seconds;
  for (int n = 0; n < steps; ++n) {
    const double start = wall_seconds();
    for (int m = 0; m < kTogether; ++m) jet.step(clock);
    seconds.push_back((wall_seconds() - start) / kTogether);
  }
  std::sort(seconds.begin(), seconds.end());
  const double cells = double(jet.grid().cells()), median = seconds[seconds.size() / 2];
  tell(fmt::format("jet: {} cells, axisymmetric, compressible, k-epsilon; {} threads", jet.grid().cells(),
                   thread_count()));
  tell(fmt::format(
      "median step {:.3f} ms (both stages): {:.1f} million cell-steps/s (fastest {:.1f}, slowest {:.1f})",
      median * 1e3, cells / median * 1e-6, cells / seconds.front() * 1e-6, cells / seconds.back() * 1e-6));
}

}  // namespace ejecta
