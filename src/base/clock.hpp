#pragma once
#include <cstdint>
#include <vector>

namespace ejecta {

/// One step of the time: from the clock's time to a later one, s. `to` is that of an event where the step
/// meets one, so that it may differ from `from + dt` in the last digit.
struct Step {
  double from = 0.0, dt = 0.0, to = 0.0;
};

/// Simulated time. Valve edges, output and checkpoint times are events: steps are shortened to land on them,
/// never stretched over them.
class Clock {
 public:
  double time() const { return time_; }
  std::int64_t steps() const { return steps_; }

  /// A single event. Times in the past are ignored; events that differ by rounding alone are one.
  void add_event(double time);
  /// Events at start, start + interval, ... up to `end`.
  void add_events_every(double interval, double start, double end);

  /// The step to take where the model would take dt: never longer, and such that the next event is met
  /// without a jolt. Some steps ahead of it what is left is divided into equal parts, so that a step shrinks
  /// by a tenth or so and not to whatever remains: a flow answers a sudden short step with a kick of its
  /// forces.
  Step next(double dt) const;
  /// Goes to the end of a step that next() gave.
  void tick(const Step& step);
  /// Puts the clock at a stored state (resume).
  void restore(double time, std::int64_t steps);

 private:
  /// Events without end, or as good as: not one is stored.
  struct Series {
    double start, interval, end;
    double after(double time) const;
  };
  double next_event() const;
  double land_on_events(double dt) const;
  double time_ = 0.0;
  std::int64_t steps_ = 0;
  std::vector<double> events_;  // sorted
  std::vector<Series> series_;
};

/// When something is due: at the first step at or after each multiple of an interval.
class Schedule {
 public:
  /// s; 0: at every step; below 0: never.
  explicit Schedule(double interval) : interval_(interval) {}
  bool due(double time) const;
  void done(double time) { last_ = time; }
  double last() const { return last_; }  ///< s, when it was done last; -1e300: never

 private:
  double interval_, last_ = -1e300;
};

}  // namespace ejecta
