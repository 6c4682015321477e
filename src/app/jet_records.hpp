#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/jet_model.hpp"
#include "output/history.hpp"
#include "output/run_directory.hpp"
#include "sorter/jet_profile.hpp"

namespace ejecta {

/// What a probe of the jet reads: the ideal total gauge pressure at its place, and what a transducer shows
/// whose opening averages over a disc across the jet and whose response lags (first order).
class JetProbe {
 public:
  JetProbe(const JetModel& jet, const ProbeSpec& spec, const output::RunDirectory& directory,
           std::span<const std::string> provenance);
  void advance(const JetModel& jet, double dt);
  void write(const JetModel& jet);
  nlohmann::ordered_json summary() const;

 private:
  double over_opening(const JetModel& jet) const;
  ProbeSpec spec_;
  output::HistoryFile history_;
  double reading_ = 0.0, peak_reading_ = 0.0, peak_reading_at_ = 0.0;
  double peak_total_ = 0.0, peak_total_at_ = 0.0, peak_mach_ = 0.0;
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

/// Momentum through planes across the jet, averaged while the valve is fully open.
class MomentumRecord {
 public:
  explicit MomentumRecord(const JetModel& jet);
  void advance(const JetModel& jet, double dt);
  nlohmann::ordered_json summary() const;

 private:
  std::vector<int> planes_;
  std::vector<double> height_, momentum_, mass_;
  double time_ = 0.0;
};

/// Profile of the jet across the plane at which an ejection box begins. Its velocities are those of air of
/// ambient density with the momentum of the jet: w sqrt(rho/rho_a).
JetProfile::Moment profile_moment(const JetModel& jet, double height, const std::vector<double>& radii);

}  // namespace ejecta
