#pragma once
#include <string>
#include <vector>

#include "case/case.hpp"

namespace ejecta {

/// The valve of one jet: how far it is open over time. Every command opens it after `delay` along the rise
/// law and closes it `duration` later along the fall law, from wherever it stood:
///   linear       r(x) = x                 smooth  r(x) = x^2 (3 - 2x)
///   exponential  r(x) = 1 - exp(-3x), so that 95 % is reached after one rise time
/// A trace (CSV of time in s after the command, opening 0..1) replaces the law; outside it the valve is
/// closed. Where pulses overlap the wider opening counts.
class Valve {
 public:
  /// `directory` is where a relative trace file is looked for. Throws InputError for a valve that never
  /// opens, negative times or a trace with gaps, disorder or values outside 0..1.
  explicit Valve(const ValveSpec& spec, const std::string& directory = "");

  /// 0 (closed) to 1 at time t, s
  double opening(double t) const;
  /// Total pressure in front of the orifice, Pa absolute: pa + opening (p_supply - pa)
  double total_pressure(double t, double ambient_pressure) const;
  /// Times at which the law has a kink, s, sorted: steps should land on them.
  const std::vector<double>& events() const { return events_; }
  /// From this time on the valve is closed, s (exponential law: open less than 0.1 %).
  double closed_from() const { return closed_from_; }
  /// Throws InputError when the supply cannot blow against the ambient pressure.
  void require_jet(double ambient_pressure) const;

 private:
  double pulse(double since_start) const;
  double trace_at(double since_start) const;
  ValveSpec spec_;
  std::vector<double> starts_;
  std::vector<double> trace_time_, trace_opening_;
  std::vector<double> events_;
  double closed_from_ = 0.0;
};

/// Points of a trace file: two columns, time (s) and opening (0..1), separated by a comma; a first line that
/// is not a number is a header, lines starting with # are skipped. Throws InputError naming file and line.
void read_valve_trace(const std::string& file, std::vector<double>& time, std::vector<double>& opening);

}  // namespace ejecta
