#include "sorter/splitter.hpp"

#include <algorithm>

#include "base/state_reader.hpp"

namespace ejecta {

Splitter::Splitter(const SplitterSpec& spec, const Vec3& nozzle, double undisturbed_height, double gravity_z)
    : spec_(spec),
      edge_(spec.edge ? Vec3(nozzle + Vec3((*spec.edge)[0], 0.0, (*spec.edge)[1]))
                      : Vec3(nozzle.x() + spec.distance, nozzle.y(), undisturbed_height + spec.height)),
      from_jet_(edge_.x() - nozzle.x()),
      gravity_z_(gravity_z) {}

WallSpec Splitter::wall() const {
  WallSpec wall;
  wall.name = "dividing plate";
  wall.kind = WallKind::box;
  wall.size = {spec_.length, kWidth, spec_.thickness};
  wall.point = edge_ + 0.5 * Vec3(spec_.length, 0.0, -spec_.thickness);
  wall.material = spec_.material;
  return wall;
}

void Splitter::resize(std::size_t bodies) {
  verdicts_.resize(bodies);
  approach_.resize(bodies);
  judged_.resize(bodies, true);
}

void Splitter::watch(std::span<const Body> bodies, std::span<const Vec3> before, double time, double dt) {
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Body& body = bodies[b];
    const Vec3 &from = before[b], &to = body.position;
    if (!judged_[b] || verdicts_[b] || from.x() >= edge_.x()) continue;
    const double gap = edge_.x() - to.x(), reach = 2.0 * body.shape.bounding_radius();
    if (const Vec3& v = body.velocity; gap > reach && v.x() > 0.0) {
      const double t = gap / v.x();
      approach_[b] = {v.x(), to.z() + v.z() * t + 0.5 * gravity_z_ * t * t - edge_.z(), approach_[b].near};
    }
    const bool passed = gap <= 0.0;
    approach_[b].near = approach_[b].near || gap <= reach;
    const bool thrown_back = approach_[b].near && body.velocity.x() <= 0.0 && to.z() < edge_.z();
    if (!passed && !thrown_back) continue;
    const double share = passed ? (edge_.x() - from.x()) / (to.x() - from.x()) : 1.0;
    Verdict v;
    v.clearance =
        passed ? from.z() + share * (to.z() - from.z()) - edge_.z()
               : std::min(approach_[b].clearance, approach_[b].clearance < 0.0 ? 0.0 : to.z() - edge_.z());
    v.ejected = passed && v.clearance > 0.0;
    v.time = time - (1.0 - share) * dt;
    v.thrown_back = !passed;
    const Approach free =
        approach_[b].velocity > 0.0 ? approach_[b] : Approach{body.velocity.x(), v.clearance, true};
    v.velocity_margin = free.clearance * free.velocity / from_jet_;
    verdicts_[b] = v;
  }
}

std::optional<double> Splitter::flight_clearance(std::size_t body) const {
  if (!(approach_.at(body).velocity > 0.0)) return std::nullopt;
  return approach_[body].clearance;
}

bool Splitter::all_passed() const {
  bool any = false;
  for (std::size_t b = 0; b < verdicts_.size(); ++b) {
    if (judged_[b] && !verdicts_[b]) return false;
    any = any || judged_[b];
  }
  return any;
}

std::vector<double> Splitter::state() const {
  std::vector<double> out;
  for (std::size_t b = 0; b < verdicts_.size(); ++b) {
    const auto& v = verdicts_[b];
    const double known = !v ? 0.0 : v->ejected ? 2.0 : v->thrown_back ? 3.0 : 1.0;
    out.insert(out.end(), {known, v ? v->clearance : 0.0, v ? v->velocity_margin : 0.0, v ? v->time : 0.0,
                           approach_[b].velocity, approach_[b].clearance, approach_[b].near ? 1.0 : 0.0});
  }
  return out;
}

void Splitter::restore(std::span<const double> state) {
  StateReader in(state, "verdicts");
  for (std::size_t b = 0; b < verdicts_.size(); ++b) {
    const int known = in.whole(0, 3);
    const Vec3 v = in.vec3();
    verdicts_[b].reset();
    if (known > 0) verdicts_[b] = Verdict{known == 2, v[0], v[1], v[2], known == 3};
    approach_[b].velocity = in.number();
    approach_[b].clearance = in.number();
    approach_[b].near = in.whole(0, 1) == 1;
  }
  in.end();
}

}  // namespace ejecta
