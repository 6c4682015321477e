#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "output/figures.hpp"
#include "simulation/histories.hpp"
#include "simulation/recorded_jet.hpp"

namespace ejecta {

/// Histories and figures of a jet, with what was measured beside them.
class JetOutputs : public Outputs {
 public:
  JetOutputs(const RecordedJet& model, OutputPlace place);

  void add_events(Clock&) const override {}
  void observe(double time, std::int64_t steps) override;
  void finish(double time) override;
  void report(nlohmann::ordered_json& result) override;
  output::NamedHistories histories() const override { return histories_.in_memory(); }
  std::vector<double> state() const override;
  void restore(const std::vector<double>& state) override;

 private:
  /// Draws what was measured `of` a curve beside it (SI units) and keeps the difference.
  void compare(const std::string& of, std::span<const double> x, std::span<const double> y,
               output::Figure& figure);
  void add_centreline_figures();
  void add_line_figures();
  void add_probe_figures();

  const RecordedJet& model_;
  std::optional<output::RunDirectory> directory_;
  Histories histories_;
  output::History& orifice_;
  std::vector<output::History*> probes_;        ///< as the case lists them
  double interval_ = 0.0, next_history_ = 0.0;  ///< s
  output::Figures figures_;
  nlohmann::ordered_json compared_ = nlohmann::ordered_json::array();
};

}  // namespace ejecta
