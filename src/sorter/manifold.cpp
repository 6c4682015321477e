#include "sorter/manifold.hpp"

#include <algorithm>
#include <numeric>

#include "base/random.hpp"

namespace ejecta {

Manifold::Manifold(const Case& c) : shortest_off_(c.controller.shortest_off) {
  const auto count = static_cast<std::size_t>(c.manifold.valves);
  dead_.assign(count, false);
  const CounterRandom random(static_cast<std::uint64_t>(c.sorter.seed), std::uint64_t{1} << 61);
  // As many as the share says, rounded; which ones, by drawing lots.
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return random.uniform(a) < random.uniform(b); });
  const auto dead = static_cast<std::size_t>(c.manifold.dead * static_cast<double>(count) + 0.5);
  for (std::size_t n = 0; n < dead; ++n) dead_[order[n]] = true;
  for (const int valve : c.manifold.dead_valves)
    if (valve >= 0 && valve < c.manifold.valves) dead_[static_cast<std::size_t>(valve)] = true;
  for (std::size_t n = 0; n < count; ++n)
    delay_.push_back(c.manifold.delay_spread * random.normal(count + n));
}

int Manifold::dead_count() const { return static_cast<int>(std::count(dead_.begin(), dead_.end(), true)); }

ValvePulses Manifold::pulses(std::span<const ValveCommand> commands, bool with_dead) const {
  ValvePulses list(dead_.size());
  for (const ValveCommand& c : commands)
    for (int v = c.first; v <= c.last; ++v)
      if (with_dead || !dead_[static_cast<std::size_t>(v)])
        list[static_cast<std::size_t>(v)].push_back({.from = c.from, .to = c.to});
  for (auto& pulses : list) {
    std::sort(pulses.begin(), pulses.end(),
              [](const ValvePulse& a, const ValvePulse& b) { return a.from < b.from; });
    std::vector<ValvePulse> merged;
    for (const ValvePulse& p : pulses) {
      if (!merged.empty() && p.from - merged.back().to <= shortest_off_)
        merged.back().to = std::max(merged.back().to, p.to);
      else merged.push_back(p);
    }
    pulses = std::move(merged);
  }
  return list;
}

}  // namespace ejecta
