#include "simulation/sorter_correction.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "base/error.hpp"
#include "base/random.hpp"

namespace ejecta {
namespace {

using Json = nlohmann::ordered_json;

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

DrawnShots draw_shots(const Case& c, const Sorter& sorter, const SorterState& state, int count) {
  if (c.feed.presentation == Presentation::independent)
    throw InputError(
        "shots of a feed whose particles may lie in each other cannot be computed as runs\n"
        "  expected: particles that lie beside each other\n  example:  [feed] presentation = \"monolayer\"");
  const CounterRandom random(static_cast<std::uint64_t>(c.sorter.seed), std::uint64_t{1} << 60);
  DrawnShots drawn;
  std::map<std::pair<std::int64_t, std::size_t>, int> known;
  for (int n = 0; n < count; ++n) {
    const auto draw = static_cast<std::uint64_t>(n);
    const auto cell = static_cast<std::int64_t>(random.uniform(2 * draw) * static_cast<double>(state.cells));
    std::vector<Shot> shots = sorter.shots(cell);
    DrawnShots::Draw& d = drawn.draws.emplace_back();
    if (shots.empty()) continue;
    const auto which =
        static_cast<std::size_t>(random.uniform(2 * draw + 1) * static_cast<double>(shots.size()));
    d.weight = static_cast<double>(state.cells) * static_cast<double>(shots.size());
    if (shots[which].valves.empty() || shots[which].bodies.empty()) continue;
    const auto [at, fresh] = known.try_emplace({cell, which}, static_cast<int>(drawn.runs.size()));
    if (fresh) drawn.runs.push_back({cell, which, std::move(shots[which])});
    d.run = at->second;
  }
  return drawn;
}

Json corrected_products(const Case& c, const SorterState& state, const DrawnShots& drawn,
                        const std::function<ResolvedShot(std::size_t)>& outcome) {
  std::vector<std::array<double, 2>> number, mass;
  int failed = 0, computed = 0;
  std::string first_failure;
  GainErrors all;
  std::map<std::string, GainErrors> by_class;
  for (const DrawnShots::Draw& draw : drawn.draws) {
    std::array<double, 2> more_number{}, more_mass{};
    if (draw.run >= 0) {
      const ResolvedShot run = outcome(static_cast<std::size_t>(draw.run));
      if (!run.failure.empty()) {
        if (failed++ == 0) first_failure = run.failure;
        continue;
      }
      ++computed;
      const Shot& shot = drawn.runs[static_cast<std::size_t>(draw.run)].shot;
      for (std::size_t b = 0; b < shot.bodies.size(); ++b) {
        const ShotBody& body = shot.bodies[b];
        all.add(run.bodies[b], body);
        by_class[c.classes[static_cast<std::size_t>(body.particle.kind)].name].add(run.bodies[b], body);
        if (!body.counts) continue;
        const double more = draw.weight * (int(run.bodies[b].ejected) - int(body.ejected));
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
