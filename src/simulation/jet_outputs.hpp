#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "output/figures.hpp"
#include "output/history.hpp"
#include "output/run_directory.hpp"
#include "simulation/recorded_jet.hpp"

namespace ejecta {

/// Histories and figures of a jet, with what was measured beside them.
class JetOutputs : public Outputs {
 public:
  JetOutputs(const RecordedJet& model, const output::RunDirectory& directory,
             const std::vector<std::string>& provenance, std::optional<double> resumed);

  void add_events(Clock&) const override {}
  void observe(double time, std::int64_t steps) override;
  void finish(double time) override;
  void report(nlohmann::ordered_json& result) override;
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
  output::RunDirectory directory_;
  std::vector<std::string> provenance_;
  std::unique_ptr<output::HistoryFile> orifice_;
  std::vector<std::unique_ptr<output::HistoryFile>> probes_;  ///< as the case lists them
  double interval_ = 0.0, next_history_ = 0.0;                ///< s
  output::Figures figures_;
  nlohmann::ordered_json compared_ = nlohmann::ordered_json::array();
};

}  // namespace ejecta
