#include "sorter/splitter.hpp"

#include <algorithm>

namespace ejecta {

Splitter::Splitter(const SplitterSpec& spec, const Vec3& nozzle, double undisturbed_height)
    : edge_(nozzle.x() + spec.distance, nozzle.y(), undisturbed_height + spec.height),
      flight_distance_(spec.distance) {}

void Splitter::watch(std::span<const Body> bodies, std::span<const Vec3> before, double time, double dt) {
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Vec3 &from = before[b], &to = bodies[b].position;
    if (verdicts_[b] || from.x() >= edge_.x() || to.x() < edge_.x()) continue;
    const double share = (edge_.x() - from.x()) / (to.x() - from.x());
    Verdict v;
    v.clearance = from.z() + share * (to.z() - from.z()) - edge_.z();
    v.ejected = v.clearance > 0.0;
    v.time = time - (1.0 - share) * dt;
    v.velocity_margin = v.clearance * bodies[b].velocity.x() / flight_distance_;
    verdicts_[b] = v;
  }
}

bool Splitter::all_passed() const {
  return std::all_of(verdicts_.begin(), verdicts_.end(), [](const auto& v) { return v.has_value(); });
}

std::vector<double> Splitter::state() const {
  std::vector<double> out;
  for (const auto& v : verdicts_)
    out.insert(out.end(), {double(v.has_value()), v ? v->clearance : 0.0, v ? v->velocity_margin : 0.0,
                           v ? v->time : 0.0});
  return out;
}

void Splitter::restore(std::span<const double> state) {
  verdicts_.assign(state.size() / 4, std::nullopt);
  for (std::size_t b = 0; b < verdicts_.size(); ++b)
    if (const double* s = state.data() + 4 * b; s[0] != 0.0)
      verdicts_[b] = Verdict{s[1] > 0.0, s[1], s[2], s[3]};
}

}  // namespace ejecta
