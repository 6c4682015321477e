#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/jet_analysis.hpp"
#include "output/history.hpp"
#include "output/run_directory.hpp"
#include "sorter/jet_profile.hpp"

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

/// Momentum through the planes across the jet, averaged over time: sound that runs to and fro in the box
/// shakes the pressure of a whole plane.
class MomentumRecord {
 public:
  explicit MomentumRecord(const JetModel& jet);
  /// What flows now counts for the last dt.
  void observe(const JetModel& jet, double dt);
  /// N, through the lower face of each cell and the upper end; zeros before the first observation.
  std::vector<double> mean() const;
  double thrust() const { return time_ > 0.0 ? thrust_ / time_ : 0.0; }  ///< N, of the orifice
  const std::vector<double>& heights() const { return height_; }         ///< m above the orifice
  /// Smallest and largest over that of the orifice's plane, and a dozen heights over the thrust.
  nlohmann::ordered_json summary() const;

 private:
  std::vector<double> height_, sum_;
  double thrust_ = 0.0, time_ = 0.0;
};

/// Profile of the jet across the plane at which an ejection box begins. Its velocities are those of air of
/// ambient density with the momentum of the jet: w sqrt(rho/rho_a).
JetProfile::Moment profile_moment(const JetModel& jet, double height, const std::vector<double>& radii);

}  // namespace ejecta
