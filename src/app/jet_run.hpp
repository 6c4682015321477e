#pragma once
#include <optional>
#include <string>
#include <vector>

#include "app/jet_figures.hpp"
#include "app/jet_files.hpp"
#include "app/jet_records.hpp"
#include "app/simulation.hpp"
#include "jet/momentum.hpp"
#include "jet/settled.hpp"
#include "jet/store.hpp"
#include "output/progress.hpp"

namespace ejecta {

/// One computation of a jet with everything that is recorded of it.
class JetRun {
 public:
  /// Throws InputError when the case computes no jet, a measurement cannot be read, or the run directory
  /// exists. The jet is kept as it crosses the plane `kept_at`, m above the orifice.
  JetRun(const Case& c, double kept_at, const RunOptions& options);
  void advance_to_end();
  void write_result();

 private:
  void write_histories();
  void observe();
  void show();
  /// Draws what was measured `of` a curve beside it (SI units) and keeps the difference.
  void compare(const std::string& of, std::span<const double> x, std::span<const double> y,
               output::Figure& figure);
  void add_centreline_figures();
  void add_line_figures();
  void add_probe_figures();
  output::ProgressState state(double dt) const;

  JetModel jet_;
  std::vector<MeasuredCurve> measured_;  ///< as the case lists them
  output::RunDirectory directory_;       ///< made last of what can fail: it clears a finished run
  output::Provenance provenance_;
  std::vector<std::string> lines_;
  OrificeRecord orifice_;
  MomentumRecord momentum_;
  ProfileRecorder profile_;
  std::vector<JetProbe> probes_;
  output::Progress progress_;
  bool quiet_;
  double interval_, next_history_ = 0.0, shown_at_ = 0.0, unseen_ = 0.0, wall_ = 0.0;
  double fully_open_from_ = -1.0, momentum_seen_at_ = 0.0;  ///< s

  // The jet at the end of the command, when it blows its strongest
  bool shown_ = false;
  Centreline line_;
  std::vector<LineProfile> profiles_;  ///< as the case lists its lines
  output::Picture picture_;
  nlohmann::ordered_json at_full_;
  std::optional<SettledJet> incompressible_;

  output::Figures figures_;
  nlohmann::ordered_json compared_ = nlohmann::ordered_json::array();
};

}  // namespace ejecta
