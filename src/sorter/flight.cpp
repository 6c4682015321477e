#include "sorter/flight.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "dem/rotation.hpp"
#include "sorter/launch.hpp"
#include "sorter/splitter.hpp"

namespace ejecta {
namespace {

constexpr double kAirStep = Track::kStep;  ///< s, of the flight through air

constexpr std::size_t kMostBlows = 64;  ///< that a body meets at once

double bounding_radius(const FeedParticle& p) { return p.scale * p.prototype->shape.bounding_radius(); }

/// Changes velocity and spin as the load does in dt.
void kick(BodyState& s, const FeedParticle& p, const Load& load, double dt) {
  s.velocity += dt / p.mass * load.force;
  const double density = p.mass / (p.prototype->volume * std::pow(p.scale, 3));
  const Vec3 inertia = density * std::pow(p.scale, 5) * p.prototype->inertia;
  const Mat3 turn = s.orientation.toRotationMatrix();
  const Vec3 spin_body = turn.transpose() * s.spin, torque_body = turn.transpose() * load.torque;
  const Vec3 momentum_body = inertia.cwiseProduct(spin_body);
  s.spin += dt * (turn * (torque_body - spin_body.cross(momentum_body)).cwiseQuotient(inertia));
}

constexpr double kNever = 1e300;     ///< s
constexpr double kLeastGain = 1e-3;  ///< m/s: less is no touch

}  // namespace

void BodyState::drift(double dt) {
  position += dt * velocity;
  turn(orientation, dt * spin);
}

BodyState BodyState::after(double dt, const Vec3& gravity) const {
  BodyState s = *this;
  s.position += dt * velocity + 0.5 * dt * dt * gravity;
  s.velocity += dt * gravity;
  turn(s.orientation, dt * spin);
  return s;
}

BodyState Track::at(double time) const {
  if (states.empty() || time >= until()) return end.after(time - until(), gravity);
  if (time <= from) return states.front().after(time - from, gravity);
  const auto n = std::min(static_cast<std::size_t>((time - from) / kStep), states.size() - 1);
  const BodyState &a = states[n], &b = n + 1 < states.size() ? states[n + 1] : end;
  const double share = (time - from) / kStep - static_cast<double>(n);
  return {.position = a.position + share * (b.position - a.position),
          .velocity = a.velocity + share * (b.velocity - a.velocity),
          .spin = a.spin + share * (b.spin - a.spin),
          .orientation = a.orientation.slerp(share, b.orientation)};
}

FastFlight::FastFlight(const Case& c, const JetField& field, const AirCoefficients& coefficients)
    : field_(field), coefficients_(coefficients), launch_(c.launch), gravity_(c.environment.gravity.z()) {
  launch_.offset_along = launch_.offset_across = launch_.arrives_at = 0.0;
  height_ = launch_.stand_off;
  const double plate = c.splitter.edge ? (*c.splitter.edge)[0] : c.splitter.distance;
  const Splitter splitter(c.splitter, Vec3::Zero(),
                          launch_height_at(launch_, Vec3::Zero(), {0, 0, gravity_}, plate), gravity_);
  edge_x_ = splitter.edge().x();
  edge_z_ = splitter.edge().z();
}

bool FastFlight::may_meet(const Flyer& f, const Blow& blow) const {
  const double away = reach(*f.particle);
  if (std::abs(f.y - blow.y) > away) return false;
  const double passes = away / launch_.belt_speed;
  return blow.pulse.from < f.at + passes &&
         blow.pulse.from + field_.still_from(2.0 * height_, blow.pulse.to - blow.pulse.from) > f.at - passes;
}

double FastFlight::widening(const FeedParticle& p) const {
  return coefficients_.widening(p, height_ * field_.half_radius());
}

double FastFlight::reach(const FeedParticle& p) const {
  return bounding_radius(p) + widening(p) * field_.reach(height_);
}

Load FastFlight::load(const FeedParticle& p, const BodyState& s, const Begin& begin, double time,
                      const Hidden& hidden) const {
  const Prototype& proto = *p.prototype;
  const double radius = bounding_radius(p),
               far = radius + begin.widening * field_.reach(s.position.z() + radius);
  std::array<const Blow*, kMostBlows> near{};
  std::size_t count = 0;
  for (const Blow& blow : begin.blows) {
    const double since = time - blow.pulse.from, dy = s.position.y() - blow.y;
    if (since > 0.0 && since < field_.still_from(s.position.z() + radius, blow.pulse.to - blow.pulse.from) &&
        s.position.x() * s.position.x() + dy * dy < far * far && count < kMostBlows)
      near[count++] = &blow;
  }
  Load load;
  if (count == 0) return load;
  const Mat3 turn = s.orientation.toRotationMatrix();
  const double whole_coefficient = coefficients_.of(p), front = coefficients_.front * whole_coefficient,
               back = whole_coefficient - front;
  const double area_scale = p.scale * p.scale;
  for (const Prototype::Piece& piece : proto.surface) {
    const Vec3 arm = p.scale * (turn * piece.point), at = s.position + arm;
    Vec3 momentum = Vec3::Zero();  // of all jets: it adds up where they meet (Reichardt 1942)
    for (std::size_t n = 0; n < count; ++n) {
      const Blow& blow = *near[n];
      const double dx = at.x(), dy = at.y() - blow.y, r = std::sqrt(dx * dx + dy * dy);
      const JetField::Air air =
          field_.at(r, at.z(), time - blow.pulse.from, blow.pulse.to - blow.pulse.from, begin.widening);
      if (air.axial == 0.0 || (hidden && hidden(blow, at))) continue;
      const double inverse = r > 1e-9 ? air.radial / r : 0.0;
      const Vec3 u(inverse * dx, inverse * dy, air.axial);
      momentum += blow.pulse.strength * u.norm() * u;
    }
    const double size = momentum.norm();
    if (size == 0.0) continue;
    const Vec3 air = momentum / std::sqrt(size), wind = air - s.velocity - s.spin.cross(arm);
    const Vec3 area = area_scale * (turn * piece.area);
    const double whole = area.norm(), normal = wind.dot(area) / whole;  // > 0: faces away
    const Vec3 push = (normal < 0.0 ? front : back) * field_.density() * normal * std::abs(normal) * area;
    load.force += push;
    load.torque += arm.cross(push);
  }
  return load;
}

FastFlight::Begin FastFlight::begin(const Flyer& f) const {
  Begin b{.blows = {}, .from = 1e300, .until = -1e300, .widening = widening(*f.particle)};
  for (const Blow& blow : f.blows)
    if (may_meet(f, blow)) {
      b.blows.push_back(blow);
      b.from = std::min(b.from, blow.pulse.from);
      b.until = std::max(b.until,
                         blow.pulse.from + field_.still_from(2.0 * height_, blow.pulse.to - blow.pulse.from));
    }
  b.from = b.blows.empty() ? f.at : std::max(b.from, f.at - reach(*f.particle) / launch_.belt_speed);
  return b;
}

BodyState FastFlight::free_state(const Flyer& f, double time) const {
  const FlightState start = launch_state(launch_, Vec3::Zero(), gravity(), time - f.at);
  BodyState s{.position = start.position + Vec3(0, f.y, 0),
              .velocity = start.velocity,
              .spin = f.particle->spin,
              .orientation = f.particle->turned * orientation_of(*f.particle)};
  const double left_belt = f.at - launch_.drop_distance / launch_.belt_speed;
  turn(s.orientation, (time - left_belt) * s.spin);
  return s;
}

bool FastFlight::is_past(const Flyer& f, const BodyState& s) const {
  return s.position.x() >= reach(*f.particle) || s.position.x() >= edge_x_;
}

FlightEnd FastFlight::fly(const Flyer& f) const {
  const Begin b = begin(f);
  BodyState s = free_state(f, b.from);
  Track track{.gravity = gravity(), .from = b.from};
  double fell = 0.0;  // m/s, by gravity
  const double v0 = s.velocity.z();
  for (double time = b.from; time < b.until && !is_past(f, s); time += kAirStep) {
    track.states.push_back(s);
    s.drift(0.5 * kAirStep);
    kick(s, *f.particle, load(*f.particle, s, b, time + 0.5 * kAirStep), kAirStep);
    s.velocity.z() += kAirStep * gravity_;
    fell += kAirStep * gravity_;
    s.drift(0.5 * kAirStep);
  }
  track.end = s;
  return finish(std::move(track), s.velocity.z() - v0 - fell);
}

double FastFlight::time_to_edge(const BodyState& s) const {
  if (s.position.x() >= edge_x_) return 0.0;
  return s.velocity.x() > 0.0 ? (edge_x_ - s.position.x()) / s.velocity.x() : kNever;
}

FlightEnd FastFlight::pass(const Vec3& before, const Vec3& after, double gain) const {
  const Vec3 there = before + (edge_x_ - before.x()) / (after.x() - before.x()) * (after - before);
  return {
      .gain = gain, .clearance = there.z() - edge_z_, .y = there.y(), .touched = std::abs(gain) > kLeastGain};
}

FlightEnd FastFlight::finish(Track track, double gain) const {
  const double left = time_to_edge(track.end);
  track.passes = track.until() + (left < kNever ? left : 0.0);
  const BodyState there = track.at(track.passes);
  return {.gain = gain,
          .clearance = left < kNever ? there.position.z() - edge_z_ : -edge_z_,
          .y = there.position.y(),
          .touched = std::abs(gain) > kLeastGain,
          .track = std::move(track)};
}

double AirCoefficients::of(const FeedParticle& p) const {
  if (p.prototype->sharp) return sharp;
  const double at = std::clamp((p.size() - small) / (large - small), 0.0, 1.0);
  return round_small + at * (round_large - round_small);
}

double AirCoefficients::widening(const FeedParticle& p, double half_radius) const {
  if (p.prototype->sharp || !(half_radius > 0.0)) return sharp_widening;
  return std::hypot(1.0,
                    round_spread * p.scale * std::sqrt(p.prototype->area / std::numbers::pi) / half_radius);
}

}  // namespace ejecta
