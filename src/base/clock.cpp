#include "base/clock.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ejecta {
namespace {
constexpr double kSnap = 1e-9;  // relative to the step
constexpr double kNever = std::numeric_limits<double>::infinity();

/// How many steps ahead of an event what is left is shared out: more make the parts more like the steps
/// before, and cost a part of a step more for each event.
constexpr double kAhead = 6.0;
/// By so much the model's dt may fall from one step to the next without one part more. Without this room the
/// last part would often be just too long, and be halved.
constexpr double kFall = 0.01;

/// Into how many equal parts a way of `steps` times dt is divided.
double parts(double steps) {
  double n = std::max(1.0, std::ceil(steps * (1.0 - kSnap)));
  if (std::abs(steps - n) <= 1e-6 * steps) return n;  // steps that fit stay as they are
  while (steps > n * std::pow(1.0 - kFall, n - 1.0) * (1.0 + kSnap)) n += 1.0;
  return n;
}

/// 55 * 0.2 ms and 11 * 1 ms differ in the last digit and are one event: a step between them would divide by
/// nothing.
bool is_same(double a, double b) { return std::abs(a - b) <= 1e-12 * std::max(std::abs(a), std::abs(b)); }
}  // namespace

void Clock::add_event(double time) {
  events_.insert(std::upper_bound(events_.begin(), events_.end(), time), time);
}

void Clock::add_events_every(double interval, double start, double end) {
  if (interval > 0.0) series_.push_back({start, interval, end * (1.0 + 1e-12)});
}

double Clock::Series::after(double time) const {
  if (time < start) return start <= end ? start : kNever;
  double n = std::floor((time - start) / interval);  // whole in a double up to 2^53
  for (int tries = 0; tries < 3 && start + n * interval <= time; ++tries) n += 1.0;
  // Nearer to one another than numbers are: the next number.
  const double t = std::max(start + n * interval, std::nextafter(time, kNever));
  return t <= end ? t : kNever;
}

/// Of events that are the same the last counts, so that all of them have come when it has.
double Clock::next_event() const {
  const auto first = std::upper_bound(events_.begin(), events_.end(), time_);
  double next = first == events_.end() ? kNever : *first;
  for (const Series& s : series_) next = std::min(next, s.after(time_));
  if (next == kNever) return next;
  double last = next;
  for (auto at = first; at != events_.end() && is_same(*at, next); ++at) last = *at;
  for (const Series& s : series_)
    if (const double t = s.after(time_); is_same(t, next)) last = std::max(last, t);
  return last;
}

double Clock::land_on_events(double dt) const {
  const double left = next_event() - time_, steps = left / dt;
  return steps * (1.0 - kSnap) > kAhead ? dt : left / parts(steps);
}

Step Clock::next(double dt) const {
  dt = land_on_events(dt);
  const double event = next_event(), to = time_ + dt;
  return {time_, dt, std::abs(event - to) <= kSnap * dt ? event : to};
}

void Clock::tick(const Step& step) {
  time_ = step.to;
  ++steps_;
}

bool Schedule::due(double time) const {
  if (interval_ < 0.0) return false;
  const double next =
      interval_ > 0.0 ? (std::floor(last_ / interval_ * (1.0 + 1e-9)) + 1.0) * interval_ : last_;
  return time >= next * (1.0 - 1e-9);
}

void Clock::restore(double time, std::int64_t steps) {
  time_ = time;
  steps_ = steps;
}

}  // namespace ejecta
