#pragma once
#include <nlohmann/json.hpp>
#include <vector>

#include "base/state_reader.hpp"
#include "jet/model.hpp"

namespace ejecta {

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
  void save(std::vector<double>& out) const;
  void load(StateReader& in);

 private:
  std::vector<double> height_, sum_;
  double thrust_ = 0.0, time_ = 0.0;
};

}  // namespace ejecta
