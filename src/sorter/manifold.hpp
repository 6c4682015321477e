#pragma once
#include <span>
#include <vector>

#include "case/case.hpp"
#include "sorter/feed_particle.hpp"

namespace ejecta {

/// The row of valves: which of them open, and when.
class Manifold {
 public:
  explicit Manifold(const Case& c);

  /// By valve, in ascending time. Commands that overlap, or lie nearer than the shortest break, become one.
  /// Without `with_dead` dead valves do not open.
  ValvePulses pulses(std::span<const ValveCommand> commands, bool with_dead = false) const;
  bool is_dead(int valve) const { return dead_[static_cast<std::size_t>(valve)]; }
  int dead_count() const;
  /// s, that a valve is slower than its kind.
  double delay(int valve) const { return delay_[static_cast<std::size_t>(valve)]; }

 private:
  double shortest_off_;
  std::vector<bool> dead_;
  std::vector<double> delay_;
};

}  // namespace ejecta
