#pragma once
#include <cstdint>
#include <vector>

namespace ejecta {

/// Simulated time. Valve edges, output and checkpoint times are events: steps are shortened to land on them,
/// never stretched over them.
class Clock {
 public:
  double time() const { return time_; }
  std::int64_t step() const { return step_; }

  /// A single event. Times in the past are ignored; events that differ by rounding alone are one.
  void add_event(double time);
  /// Events at start, start + interval, ... up to `end`.
  void add_events_every(double interval, double start, double end);

  /// The step to take where the model would take dt: never longer, and such that the next event is met
  /// without a jolt. Some steps ahead of it what is left is divided into equal parts, so that a step shrinks
  /// by a tenth or so and not to whatever remains: a flow answers a sudden short step with a kick of its
  /// forces.
  double land_on_events(double dt) const;
  /// Advances by dt; snaps onto an event that dt was meant to reach.
  void tick(double dt);
  /// Puts the clock at a stored state (resume).
  void restore(double time, std::int64_t step);

 private:
  /// Events without end, or as good as: not one is stored.
  struct Series {
    double start, interval, end;
    double after(double time) const;
  };
  double next_event() const;
  double time_ = 0.0;
  std::int64_t step_ = 0;
  std::vector<double> events_;  // sorted
  std::vector<Series> series_;
};

}  // namespace ejecta
