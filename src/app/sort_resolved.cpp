#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "app/sort_runs.hpp"
#include "base/error.hpp"
#include "base/random.hpp"
#include "simulation/forecast.hpp"
#include "simulation/sorter_shot.hpp"
#include "study/local.hpp"
#include "study/study.hpp"

namespace ejecta {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// A shot drawn at random: first a cell of the belt, then one of its shots.
struct DrawnShot {
  std::size_t task = 0;
  bool any = false;     ///< false: there is none in that cell
  double weight = 0.0;  ///< how many shots of the machine it stands for
  Shot shot{};
};

/// What the runs find more than the fast tier, of all particles of the machine: estimate and its variance.
struct Correction {
  double wanted = 0.0, others = 0.0;
  double wanted_variance = 0.0, others_variance = 0.0, covariance = 0.0;
};

void put(Json& r, const std::string& name, double value, double error) {
  r[name] = std::clamp(value, 0.0, 1.0);
  r[name + "_low"] = std::clamp(value - 1.959964 * error, 0.0, 1.0);
  r[name + "_high"] = std::clamp(value + 1.959964 * error, 0.0, 1.0);
}

/// Of a sum over the belt: mean of the samples and its variance.
Correction correction_of(const std::vector<std::array<double, 2>>& samples) {
  Correction c;
  const auto n = static_cast<double>(samples.size());
  for (const auto& [wanted, others] : samples) {
    c.wanted += wanted / n;
    c.others += others / n;
  }
  for (const auto& [wanted, others] : samples) {
    c.wanted_variance += (wanted - c.wanted) * (wanted - c.wanted) / (n * (n - 1.0));
    c.others_variance += (others - c.others) * (others - c.others) / (n * (n - 1.0));
    c.covariance += (wanted - c.wanted) * (others - c.others) / (n * (n - 1.0));
  }
  return c;
}

/// How the fast tier's gains of velocity differ from those of the runs.
struct GainErrors {
  int bodies = 0, same = 0, gains = 0;
  double sum = 0.0, squares = 0.0;
  void add(const ResolvedBody& run, const ShotBody& fast) {
    constexpr double kLeastGain = 0.1;  // m/s: smaller ones eject nothing
    ++bodies;
    same += run.ejected == fast.ejected;
    if (run.gain < kLeastGain) return;
    const double error = fast.gain / run.gain - 1.0;
    ++gains;
    sum += error;
    squares += error * error;
  }
  Json json() const {
    Json r{{"bodies", bodies}, {"same_verdict", same}, {"gains_above_0_1_m_s", gains}};
    if (gains > 0) {
      r["gain_bias"] = sum / gains;
      r["gain_rms_error"] = std::sqrt(squares / gains);
    }
    return r;
  }
};

double error_of(const Share& s) { return s.known ? (s.high - s.low) / (2.0 * 1.959964) : 0.0; }

}  // namespace

Json resolve_shots(const Case& c, const Sorter& sorter, const SorterState& state, const fs::path& directory,
                   const ResolvedOptions& o) {
  if (c.feed.presentation == Presentation::independent)
    throw InputError(
        "shots of a feed whose particles may lie in each other cannot be computed as runs\n"
        "  expected: particles that lie beside each other\n  example:  [feed] presentation = \"monolayer\"");
  const CounterRandom random(static_cast<std::uint64_t>(c.sorter.seed), std::uint64_t{1} << 60);
  std::vector<DrawnShot> drawn;
  std::vector<NewTask> runs;
  std::map<std::pair<std::int64_t, std::size_t>, std::size_t> known;
  for (int n = 0; n < o.shots; ++n) {
    const auto draw = static_cast<std::uint64_t>(n);
    const auto cell = static_cast<std::int64_t>(random.uniform(2 * draw) * static_cast<double>(state.cells));
    const std::vector<Shot> shots = sorter.shots(cell);
    DrawnShot d;
    if (!shots.empty()) {
      const auto which =
          static_cast<std::size_t>(random.uniform(2 * draw + 1) * static_cast<double>(shots.size()));
      d = {.any = !shots[which].valves.empty() && !shots[which].bodies.empty(),
           .weight = static_cast<double>(state.cells) * static_cast<double>(shots.size()),
           .shot = shots[which]};
      if (d.any) {
        const auto [at, fresh] = known.try_emplace({cell, which}, runs.size());
        if (fresh)
          runs.push_back({resolved_case(c, d.shot),
                          {{"cell", cell},
                           {"shot", which},
                           {"bodies", d.shot.bodies.size()},
                           {"valves", d.shot.valves.size()}}});
        d.task = at->second;
      }
    }
    drawn.push_back(std::move(d));
  }
  TaskStore store = TaskStore::create(directory, study_header("resolved shots", c), false);
  const std::vector<std::size_t> tasks = store.add(runs);
  if (!tasks.empty()) {
    const StudyDriver driver(store);
    store.ask_to_stop(false);
    const int at_once = runs_side_by_side(runs.front().resolved);
    if (!run_locally(store, tasks,
                     {.program = fs::read_symlink("/proc/self/exe"),
                      .at_once = at_once,
                      .threads = 1,
                      .stop = o.stop,
                      .look = {}}))
      return nullptr;
  }
  std::vector<std::array<double, 2>> number, mass;
  int failed = 0, computed = 0;
  std::string first_failure;
  GainErrors all;
  std::map<std::string, GainErrors> by_class;
  for (const DrawnShot& d : drawn) {
    std::array<double, 2> more_number{}, more_mass{};
    if (d.any) {
      const std::size_t task = tasks[d.task];
      if (store.state(task) != TaskState::done) {
        if (failed++ == 0) first_failure = store.failure(task);
        continue;
      }
      ++computed;
      const std::vector<ResolvedBody> runs_bodies = resolved_bodies(store.result(task).at("result"));
      for (std::size_t b = 0; b < d.shot.bodies.size(); ++b) {
        const ShotBody& body = d.shot.bodies[b];
        all.add(runs_bodies[b], body);
        by_class[c.classes[static_cast<std::size_t>(body.particle.kind)].name].add(runs_bodies[b], body);
        if (!body.counts) continue;
        const double more = d.weight * (int(runs_bodies[b].ejected) - int(body.ejected));
        const std::size_t side = c.classes[static_cast<std::size_t>(body.particle.kind)].eject ? 0 : 1;
        more_number[side] += more;
        more_mass[side] += more * body.particle.mass;
      }
    }
    number.push_back(more_number);
    mass.push_back(more_mass);
  }
  Json r{
      {"resolved_shots", computed}, {"resolved_shots_failed", failed}, {"fast_against_resolved", all.json()}};
  if (failed > 0) r["first_failure"] = first_failure;
  for (const auto& [name, errors] : by_class) r["fast_against_resolved"][name] = errors.json();
  if (computed < 2) return r;  // nothing to correct with
  const auto& sums = state.products.sums;
  for (const bool by_mass : {false, true}) {
    const Correction k = correction_of(by_mass ? mass : number);
    const std::size_t first = by_mass ? Products::recovery_mass : Products::recovery;
    const std::string end = by_mass ? "_mass" : "";
    const ShareSums &recovery = sums[first], &purity = sums[first + 1], &loss = sums[first + 2];
    const auto together = [](double a, double variance) {
      return std::sqrt(a * a + std::max(variance, 0.0));
    };
    if (recovery.b > 0.0)
      put(r, "recovery" + end, (recovery.a + k.wanted) / recovery.b,
          together(error_of(recovery.share()), k.wanted_variance / (recovery.b * recovery.b)));
    if (loss.b > 0.0)
      put(r, "loss" + end, (loss.a + k.others) / loss.b,
          together(error_of(loss.share()), k.others_variance / (loss.b * loss.b)));
    const double ejected = purity.b + k.wanted + k.others;
    if (ejected > 0.0) {
      const double p = (purity.a + k.wanted) / ejected;
      const double variance = ((1 - p) * (1 - p) * k.wanted_variance + p * p * k.others_variance -
                               2 * p * (1 - p) * k.covariance) /
                              (ejected * ejected);
      put(r, "purity" + end, p, together(error_of(purity.share()), variance));
    }
  }
  return r;
}

}  // namespace ejecta
