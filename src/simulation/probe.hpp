#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/state_reader.hpp"
#include "case/case.hpp"
#include "flow/model/flow_model.hpp"
#include "output/history.hpp"

namespace ejecta {

/// What is measured at one point of the flow: every quantity there, and the total pressure as an instrument
/// of some size and slowness reads it ("transducer"); with the greatest values and their times.
class Probe {
 public:
  using Quantities = std::vector<std::pair<std::string, std::string>>;  ///< name, unit

  /// `history`: null where none is kept.
  Probe(const ProbeSpec& spec, const Quantities& quantities, output::History* history);

  /// Columns of its history.
  static std::vector<output::Column> columns(const Quantities& quantities);

  /// Reads the flow `dt` (s) after it did so last.
  void read(const FlowModel& flow, double time, double dt);
  void write(double time) {
    if (history_) history_->add(time, now_);
  }
  /// Last and greatest values with their times, under their names, for result.json.
  void report(nlohmann::ordered_json& result, const Quantities& quantities) const;

  void save(std::vector<double>& out) const;
  void load(StateReader& in);

 private:
  double mean_over_opening(const FlowModel& flow);

  ProbeSpec spec_;
  std::size_t total_pressure_;                  // which quantity
  std::vector<double> now_, peak_, peak_time_;  // of the quantities, then the transducer
  std::vector<double> scratch_;
  output::History* history_;
};

}  // namespace ejecta
