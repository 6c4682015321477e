#include "jet/momentum.hpp"

#include <algorithm>

namespace ejecta {

MomentumRecord::MomentumRecord(const JetModel& jet) : sum_(jet.grid().axis(2).face.size(), 0.0) {
  for (const double z : jet.grid().axis(2).face) height_.push_back(z - jet.grid().lower().z());
}

void MomentumRecord::observe(const JetModel& jet, double dt) {
  for (std::size_t k = 0; k < sum_.size(); ++k) sum_[k] += dt * jet.through(static_cast<int>(k)).momentum;
  thrust_ += dt * jet.orifice_flow().momentum;
  time_ += dt;
}

std::vector<double> MomentumRecord::mean() const {
  std::vector<double> m = sum_;
  for (double& value : m) value /= time_ > 0.0 ? time_ : 1.0;
  return m;
}

nlohmann::ordered_json MomentumRecord::summary() const {
  constexpr int kHeights = 12;
  nlohmann::ordered_json r{{"thrust_N", thrust()}, {"averaged_over_s", time_}};
  if (time_ <= 0.0) return r;
  const std::vector<double> momentum = mean();
  const auto [low, high] = std::minmax_element(momentum.begin(), momentum.end());
  // The air drawn along the wall around the orifice sucks at it: what the jet carries is the thrust less
  // this.
  r["suction_on_wall_N"] = thrust() - momentum.front();
  r["least_over_first"] = *low / momentum.front();
  r["most_over_first"] = *high / momentum.front();
  r["heights"] = nlohmann::ordered_json::array();
  for (int n = 0; n <= kHeights; ++n) {
    const double at = height_.back() * n / kHeights * (1.0 - 1e-9);
    const auto k =
        static_cast<std::size_t>(std::lower_bound(height_.begin(), height_.end(), at) - height_.begin());
    r["heights"].push_back({{"height_m", height_[k]}, {"over_thrust", momentum[k] / thrust()}});
  }
  return r;
}

void MomentumRecord::save(std::vector<double>& out) const {
  out.insert(out.end(), {thrust_, time_});
  out.insert(out.end(), sum_.begin(), sum_.end());
}

void MomentumRecord::load(StateReader& in) {
  for (double* v : {&thrust_, &time_}) *v = in.number();
  for (double& v : sum_) v = in.number();
}

}  // namespace ejecta
