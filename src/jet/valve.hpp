#pragma once
#include <string>
#include <vector>

#include "case/case.hpp"
#include "case/problem.hpp"

namespace ejecta {

/// The opening (0..1) of a valve over the time (s) after its command, as measured.
struct ValveTrace {
  std::vector<double> time, opening;
};

/// The valve of one jet: how far it is open over time. Every command opens it after `delay` along the rise
/// law and closes it `duration` later along the fall law, from wherever it stood:
///   linear       r(x) = x                 smooth  r(x) = x^2 (3 - 2x)
///   exponential  r(x) = 1 - exp(-3x), so that 95 % is reached after one rise time
/// A trace (CSV of time after the command, opening) replaces the law; outside it the valve is
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
  ValveTrace trace_;
  std::vector<double> events_;
  double closed_from_ = 0.0;
};

/// Reads a trace file: a head with the units of its two columns, "time [ms], opening [%]", or numbers alone,
/// then in s and 0..1 (see read_csv). What is wrong goes to `problems`, with its line.
ValveTrace read_valve_trace(const std::string& file, std::vector<Problem>& problems);

}  // namespace ejecta
