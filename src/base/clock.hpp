#pragma once
#include <cstdint>
#include <vector>

namespace ejecta {

/// Simulated time. Valve edges, output and checkpoint times are events: a step is shortened to land on them,
/// never stretched over them.
class Clock {
 public:
  double time() const { return time_; }
  std::int64_t step() const { return step_; }

  /// A single event. Times in the past are ignored; events that differ by rounding alone are one.
  void add_event(double time);
  /// Events at start, start + interval, ... up to `end`.
  void add_events_every(double interval, double start, double end);

  /// The largest step <= dt that does not pass the next event; when the event is within two steps, half the
  /// way to it, so that no step becomes tiny.
  double land_on_events(double dt) const;
  /// Advances by dt; snaps onto an event that dt was meant to reach.
  void tick(double dt);
  /// Puts the clock at a stored state (resume).
  void restore(double time, std::int64_t step);

 private:
  void sort_events();
  double next_event() const;
  double time_ = 0.0;
  std::int64_t step_ = 0;
  std::vector<double> events_;  // sorted
};

}  // namespace ejecta
