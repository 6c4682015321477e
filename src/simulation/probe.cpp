#include "simulation/probe.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace ejecta {

Probe::Probe(const ProbeSpec& spec, const Quantities& quantities, output::History* history)
    : spec_(spec),
      total_pressure_(
          static_cast<std::size_t>(std::find_if(quantities.begin(), quantities.end(),
                                                [](const auto& q) { return q.first == "total_pressure"; }) -
                                   quantities.begin())),
      now_(quantities.size() + 1),
      peak_(quantities.size() + 1, -1e300),
      peak_time_(quantities.size() + 1),
      scratch_(quantities.size()),
      history_(history) {}

std::vector<output::Column> Probe::columns(const Quantities& quantities) {
  std::vector<output::Column> columns;
  for (const auto& [name, unit] : quantities) columns.push_back({name, unit});
  columns.push_back({"transducer", "Pa"});
  return columns;
}

double Probe::mean_over_opening(const FlowModel& flow) {
  double sum = now_[total_pressure_], weight = 1.0;
  for (int ring = 1; ring <= 2; ++ring)
    for (int n = 0; n < 8; ++n) {
      const double r = 0.25 * ring * spec_.diameter * 0.9, angle = 0.785398163 * n;
      flow.sample(spec_.position + r * Vec3(std::cos(angle), std::sin(angle), 0), scratch_);
      sum += ring * scratch_[total_pressure_];
      weight += ring;
    }
  return sum / weight;
}

void Probe::read(const FlowModel& flow, double time, double dt) {
  double& transducer = now_.back();
  flow.sample(spec_.position, std::span(now_).first(now_.size() - 1));
  // What the instrument reads: the mean over its opening, delayed by its first-order response.
  const double seen = spec_.diameter > 0.0 ? mean_over_opening(flow) : now_[total_pressure_];
  const double share = spec_.response_time > 0.0 ? 1.0 - std::exp(-dt / spec_.response_time) : 1.0;
  transducer += share * (seen - transducer);
  for (std::size_t q = 0; q < now_.size(); ++q)
    if (now_[q] > peak_[q]) peak_[q] = now_[q], peak_time_[q] = time;
}

void Probe::report(nlohmann::ordered_json& result, const Quantities& quantities) const {
  auto& out = result["probes"][spec_.name];
  for (std::size_t q = 0; q < now_.size(); ++q) {
    const std::string name = q < quantities.size() ? quantities[q].first : "transducer";
    out[name] = now_[q];
    out["peak_" + name] = peak_[q];
    out["peak_time_" + name] = peak_time_[q];
  }
}

void Probe::save(std::vector<double>& out) const {
  for (const auto* list : {&now_, &peak_, &peak_time_}) out.insert(out.end(), list->begin(), list->end());
}

void Probe::load(StateReader& in) {
  for (auto* list : {&now_, &peak_, &peak_time_})
    for (double& v : *list) v = in.number();
}

}  // namespace ejecta
