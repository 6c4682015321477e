#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "jet/analysis.hpp"
#include "output/history.hpp"
#include "output/run_directory.hpp"

namespace ejecta {

/// The valve counts as fully open here.
inline constexpr double kFullyOpen = 0.999;

/// What a probe of the jet reads: the ideal total gauge pressure at its place, and what a transducer shows
/// whose opening averages over a disc across the jet and whose response lags (first order).
class JetProbe {
 public:
  JetProbe(const ProbeSpec& spec, const output::RunDirectory& directory,
           std::span<const std::string> provenance);
  void advance(const JetModel& jet, double dt);
  void write(const JetModel& jet);
  nlohmann::ordered_json summary() const;
  const ProbeSpec& spec() const { return spec_; }
  /// What has been written so far: s, Pa, Pa
  const std::vector<double>& times() const { return times_; }
  const std::vector<double>& ideal() const { return ideal_; }
  const std::vector<double>& readings() const { return readings_; }

 private:
  double over_opening(const JetModel& jet) const;
  ProbeSpec spec_;
  output::HistoryFile history_;
  double reading_ = 0.0, peak_reading_ = 0.0, peak_reading_at_ = 0.0;
  double peak_total_ = 0.0, peak_total_at_ = 0.0, peak_mach_ = 0.0;
  std::vector<double> times_, ideal_, readings_;
};

/// The orifice over time: what leaves it, beside what the exact relations say.
class OrificeRecord {
 public:
  OrificeRecord(const output::RunDirectory& directory, std::span<const std::string> provenance);
  void advance(const JetModel& jet, double dt);
  void write(const JetModel& jet);
  double mass() const { return mass_; }  ///< kg so far
  nlohmann::ordered_json summary(const JetModel& jet) const;

 private:
  output::HistoryFile history_;
  double mass_ = 0.0, impulse_ = 0.0;
  // Means over the time in which the valve is fully open
  double open_time_ = 0.0, mass_flow_ = 0.0, thrust_ = 0.0, ideal_mass_flow_ = 0.0, ideal_thrust_ = 0.0;
};

}  // namespace ejecta
