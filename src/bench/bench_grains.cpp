#include "bench/bench_grains.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/parallel.hpp"
#include "base/stopwatch.hpp"
#include "case/load.hpp"
#include "simulation/coupled_model.hpp"

namespace ejecta {
namespace {

/// Grains of 0.15 mm, a quarter of the narrowest cell, all over the box.
std::string box_with_grains(const std::string& standard, int count) {
  std::string text = standard.substr(0, standard.find("[[body]]"));
  if (count == 0) return text;
  return text + fmt::format(
                    "[[grains]]\nsize = \"0.15 mm\"\ncount = {}\nmaterial = \"ore\"\npacking = \"lattice\"\n"
                    "velocity = [\"3 m/s\", \"0 m/s\", \"0 m/s\"]\n",
                    count);
}

}  // namespace

void bench_grains(const char* standard, int steps, const Note& tell) {
  tell(fmt::format("\ngrains in the flow ({} threads; median of {} steps)", thread_count(), steps));
  tell(fmt::format("{:<14}{:>10}{:>8}{:>12}{:>10}{:>10}{:>10}{:>10}", "grains", "ms/step", "times", "M g-s/s",
                   "map %", "flow %", "collect %", "motion %"));
  double plain = 0.0;
  for (const int count : {0, 100000, 1000000}) {
    CoupledModel model(parse_case(box_with_grains(standard, count), "the standard case with grains"));
    double time = 0.0;
    std::vector<double> seconds;
    std::vector<OperatorTime> before;
    for (int n = 0; n < 10 + steps; ++n) {
      if (n == 10) before = model.operator_times();
      const double start = wall_seconds(), dt = model.stable_dt(time);
      model.advance(time, dt);
      time += dt;
      if (n >= 10) seconds.push_back(wall_seconds() - start);
    }
    const auto after = model.operator_times();
    double map = 0.0, flow = 0.0, collect = 0.0, motion = 0.0;
    for (std::size_t n = 0; n < after.size(); ++n) {
      const double spent = after[n].seconds - before[n].seconds;
      (after[n].name == "map.grains"       ? map
       : after[n].name == "grains.collect" ? collect
       : after[n].name == "bodies.advance" ? motion
                                           : flow) += spent;
    }
    std::sort(seconds.begin(), seconds.end());
    const double median = seconds[seconds.size() / 2], all = 0.01 * (map + flow + collect + motion);
    if (count == 0) plain = median;
    tell(fmt::format("{:<14}{:>10.1f}{:>8.2f}{:>12.2f}{:>10.0f}{:>10.0f}{:>10.0f}{:>10.0f}", count,
                     median * 1e3, median / plain, count / median * 1e-6, map / all, flow / all,
                     collect / all, motion / all));
  }
  tell(
      "M g-s/s: million grain-steps a second; map, collect: grains to cells and back; motion: contacts and "
      "paths");
}

}  // namespace ejecta
