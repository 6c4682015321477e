#pragma once
#include <nlohmann/json.hpp>
#include <vector>

#include "base/state_reader.hpp"
#include "jet/analysis.hpp"

namespace ejecta {

/// The valve counts as fully open here.
inline constexpr double kFullyOpen = 0.999;

/// What a probe of the jet reads: the ideal total gauge pressure at its place, and what a transducer shows
/// whose opening averages over a disc across the jet and whose response lags (first order).
class JetProbe {
 public:
  explicit JetProbe(const ProbeSpec& spec) : spec_(spec) {}
  void advance(const JetModel& jet, double dt);
  double reading() const { return reading_; }  ///< Pa, of the transducer
  nlohmann::ordered_json summary() const;
  const ProbeSpec& spec() const { return spec_; }
  void save(std::vector<double>& out) const;
  void load(StateReader& in);

 private:
  double over_opening(const JetModel& jet) const;
  ProbeSpec spec_;
  double reading_ = 0.0, peak_reading_ = 0.0, peak_reading_at_ = 0.0;
  double peak_total_ = 0.0, peak_total_at_ = 0.0, peak_mach_ = 0.0;
};

/// The orifice over time: what leaves it, beside what the exact relations say.
class OrificeRecord {
 public:
  void advance(const JetModel& jet, double dt);
  double mass() const { return mass_; }  ///< kg so far
  nlohmann::ordered_json summary(const JetModel& jet) const;
  void save(std::vector<double>& out) const;
  void load(StateReader& in);

 private:
  double mass_ = 0.0, impulse_ = 0.0;
  // Means over the time in which the valve is fully open
  double open_time_ = 0.0, mass_flow_ = 0.0, thrust_ = 0.0, ideal_mass_flow_ = 0.0, ideal_thrust_ = 0.0;
};

}  // namespace ejecta
