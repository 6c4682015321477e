#include "jet/valve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/error.hpp"

namespace ejecta {
namespace {

constexpr double kTimeConstants = 3.0;  // of the exponential law within one rise or fall time

double rise(ValveShape shape, double x) {
  if (x <= 0.0) return 0.0;
  if (shape == ValveShape::exponential) return 1.0 - std::exp(-kTimeConstants * x);
  if (x >= 1.0) return 1.0;
  return shape == ValveShape::smooth ? x * x * (3.0 - 2.0 * x) : x;
}

/// Progress through a movement that takes `length`; a movement without length is over at once.
double progress(double time, double length) {
  return length > 0.0 ? time / length : (time > 0.0 ? 1e30 : 0.0);
}

void require(bool ok, std::string_view key, double value, std::string_view expected) {
  if (!ok) throw InputError(fmt::format("valve.{} is {}: expected {}", key, value, expected));
}

}  // namespace

Valve::Valve(const ValveSpec& spec, const std::string& directory) : spec_(spec) {
  require(spec.orifice_diameter > 0.0, "orifice_diameter", spec.orifice_diameter, "a length above zero");
  require(spec.discharge_coefficient > 0.0 && spec.discharge_coefficient <= 1.0, "discharge_coefficient",
          spec.discharge_coefficient, "above 0 and at most 1");
  require(spec.delay >= 0.0, "delay", spec.delay, "a time of zero or more");
  require(spec.rise_time >= 0.0, "rise_time", spec.rise_time, "a time of zero or more");
  require(spec.fall_time >= 0.0, "fall_time", spec.fall_time, "a time of zero or more");
  const bool traced = spec.shape == ValveShape::trace;
  if (traced) {
    const std::filesystem::path file = std::filesystem::path(directory) / spec.trace;
    std::vector<Problem> problems;
    trace_ = read_valve_trace(file.string(), problems);
    if (!problems.empty()) throw CaseError(problems);
  } else {
    require(spec.duration > 0.0, "duration", spec.duration, "a time above zero, or the valve never opens");
  }
  starts_ = spec.more_pulses;
  starts_.push_back(spec.opens_at);
  for (double& start : starts_) start += spec.delay;
  std::sort(starts_.begin(), starts_.end());
  for (const double start : starts_) {
    if (traced) {
      events_.insert(events_.end(), {start + trace_.time.front(), start + trace_.time.back()});
      continue;
    }
    events_.push_back(start);
    if (spec.rise_time > 0.0 && spec.rise_time < spec.duration) events_.push_back(start + spec.rise_time);
    events_.insert(events_.end(), {start + spec.duration, start + spec.duration + spec.fall_time});
  }
  std::sort(events_.begin(), events_.end());
  events_.erase(std::unique(events_.begin(), events_.end()), events_.end());
  closed_from_ = events_.back();
  if (spec.shape == ValveShape::exponential)
    closed_from_ += spec.fall_time * (std::log(1e3) / kTimeConstants - 1.0);
}

double Valve::pulse(double since_start) const {
  const double shut = since_start - spec_.duration;
  const double open = rise(spec_.shape, progress(std::min(since_start, spec_.duration), spec_.rise_time));
  return open * (1.0 - rise(spec_.shape, progress(shut, spec_.fall_time)));
}

double Valve::trace_at(double since_start) const {
  const auto above = std::upper_bound(trace_.time.begin(), trace_.time.end(), since_start);
  if (above == trace_.time.begin() || above == trace_.time.end()) return 0.0;
  const auto n = static_cast<std::size_t>(above - trace_.time.begin());
  const double x = (since_start - trace_.time[n - 1]) / (trace_.time[n] - trace_.time[n - 1]);
  return (1.0 - x) * trace_.opening[n - 1] + x * trace_.opening[n];
}

double Valve::opening(double t) const {
  double widest = 0.0;
  for (const double start : starts_)
    widest = std::max(widest, spec_.shape == ValveShape::trace ? trace_at(t - start) : pulse(t - start));
  return widest;
}

double Valve::total_pressure(double t, double ambient_pressure) const {
  return ambient_pressure + opening(t) * (spec_.supply_pressure - ambient_pressure);
}

void Valve::require_jet(double ambient_pressure) const {
  if (!(spec_.supply_pressure > ambient_pressure))
    throw InputError(
        fmt::format("valve.supply_pressure is {:.6g} kPa absolute, not above the ambient {:.6g} kPa: "
                    "there is no jet",
                    1e-3 * spec_.supply_pressure, 1e-3 * ambient_pressure));
}

}  // namespace ejecta
