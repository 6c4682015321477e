#include "base/clock.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ejecta {
namespace {
constexpr double kSnap = 1e-9;  // relative to the step

/// 55 * 0.2 ms and 11 * 1 ms differ in the last digit and are one event: a step between them would divide by
/// nothing.
bool is_same(double a, double b) { return std::abs(a - b) <= 1e-12 * std::max(std::abs(a), std::abs(b)); }
}  // namespace

void Clock::add_event(double time) {
  events_.push_back(time);
  sort_events();
}

void Clock::add_events_every(double interval, double start, double end) {
  if (!(interval > 0.0)) return;
  for (std::int64_t n = 0;; ++n) {
    const double t = start + static_cast<double>(n) * interval;
    if (t > end * (1.0 + 1e-12)) break;
    events_.push_back(t);
  }
  sort_events();
}

/// Of events that are the same the last stays, so that all of them have come when it has.
void Clock::sort_events() {
  std::sort(events_.begin(), events_.end());
  events_.erase(events_.begin(), std::unique(events_.rbegin(), events_.rend(), is_same).base());
}

double Clock::next_event() const {
  const auto at = std::upper_bound(events_.begin(), events_.end(), time_);
  return at == events_.end() ? std::numeric_limits<double>::infinity() : *at;
}

double Clock::land_on_events(double dt) const {
  const double left = next_event() - time_;
  if (left <= dt * (1.0 + kSnap)) return left;
  if (left < 2.0 * dt) return 0.5 * left;
  return dt;
}

void Clock::tick(double dt) {
  const double event = next_event();
  const double t = time_ + dt;
  time_ = std::abs(event - t) <= kSnap * dt ? event : t;
  ++step_;
}

void Clock::restore(double time, std::int64_t step) {
  time_ = time;
  step_ = step;
}

}  // namespace ejecta
