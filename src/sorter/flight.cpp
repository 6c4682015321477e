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

constexpr double kAirStep = 4e-4;  ///< s, of the flight through air

constexpr std::size_t kMostBlows = 64;  ///< that a body meets at once

double bounding_radius(const FeedParticle& p) { return p.scale * p.prototype->shape.bounding_radius(); }

}  // namespace

struct FastFlight::State {
  Vec3 position{0, 0, 0}, velocity{0, 0, 0}, spin{0, 0, 0};
  Quat orientation = Quat::Identity();
};

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

bool FastFlight::may_meet(const FeedParticle& p, double at, double y, const Blow& blow) const {
  const double away = reach(p);
  if (std::abs(y - blow.y) > away) return false;
  const double passes = away / launch_.belt_speed;
  return blow.pulse.from < at + passes &&
         blow.pulse.from + field_.still_from(2.0 * height_, blow.pulse.to - blow.pulse.from) > at - passes;
}

double FastFlight::widening(const FeedParticle& p) const {
  return coefficients_.widening(p, height_ * field_.half_radius());
}

double FastFlight::reach(const FeedParticle& p) const {
  return bounding_radius(p) + widening(p) * field_.reach(height_);
}

void FastFlight::push(State& s, const FeedParticle& p, std::span<const Blow> blows, double widening,
                      double time, double dt) const {
  const Prototype& proto = *p.prototype;
  const Mat3 turn = s.orientation.toRotationMatrix();
  const double whole_coefficient = coefficients_.of(p), front = coefficients_.front * whole_coefficient,
               back = whole_coefficient - front;
  const double area_scale = p.scale * p.scale;
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
  const double radius = bounding_radius(p), far = radius + widening * field_.reach(s.position.z() + radius);
  std::array<const Blow*, kMostBlows> near{};
  std::size_t count = 0;
  for (const Blow& blow : blows) {
    const double since = time - blow.pulse.from, dy = s.position.y() - blow.y;
    if (since > 0.0 && since < field_.still_from(s.position.z() + radius, blow.pulse.to - blow.pulse.from) &&
        s.position.x() * s.position.x() + dy * dy < far * far && count < kMostBlows)
      near[count++] = &blow;
  }
  if (count == 0) return;
  for (const Prototype::Piece& piece : proto.surface) {
    const Vec3 arm = p.scale * (turn * piece.point), at = s.position + arm;
    Vec3 momentum = Vec3::Zero();  // of all jets: it adds up where they meet (Reichardt 1942)
    for (std::size_t n = 0; n < count; ++n) {
      const Blow& blow = *near[n];
      const double dx = at.x(), dy = at.y() - blow.y, r = std::sqrt(dx * dx + dy * dy);
      const JetField::Air air =
          field_.at(r, at.z(), time - blow.pulse.from, blow.pulse.to - blow.pulse.from, widening);
      if (air.axial == 0.0) continue;
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
    force += push;
    torque += arm.cross(push);
  }
  s.velocity += dt / p.mass * force;
  const double density = p.mass / (proto.volume * std::pow(p.scale, 3));
  const Vec3 inertia = density * std::pow(p.scale, 5) * proto.inertia;
  const Vec3 spin_body = turn.transpose() * s.spin, torque_body = turn.transpose() * torque;
  const Vec3 momentum_body = inertia.cwiseProduct(spin_body);
  s.spin += dt * (turn * (torque_body - spin_body.cross(momentum_body)).cwiseQuotient(inertia));
}

FlightEnd FastFlight::fly(const FeedParticle& p, double at, double y, std::span<const Blow> blows,
                          bool keep_path) const {
  const Vec3 gravity(0, 0, gravity_);
  std::vector<Blow> near;
  double from = 1e300, until = -1e300;
  for (const Blow& b : blows)
    if (may_meet(p, at, y, b)) {
      near.push_back(b);
      from = std::min(from, b.pulse.from);
      until = std::max(until, b.pulse.from + field_.still_from(2.0 * height_, b.pulse.to - b.pulse.from));
    }
  const double away = reach(p), wide = widening(p);
  from = std::max(from, at - away / launch_.belt_speed);
  FlightEnd end;
  double time = near.empty() ? at : from;
  const FlightState start = launch_state(launch_, Vec3::Zero(), gravity, time - at);
  State s{.position = start.position + Vec3(0, y, 0),
          .velocity = start.velocity,
          .spin = p.spin,
          .orientation = p.turned * orientation_of(p)};
  const double left_belt = at - launch_.drop_distance / launch_.belt_speed;
  turn(s.orientation, (time - left_belt) * s.spin);
  end.path_from = time;
  double fell = 0.0;  // m/s, by gravity
  const double v0 = s.velocity.z();
  auto note = [&, next = time]() mutable {
    if (!keep_path || time < next - 0.5 * kAirStep) return;
    end.path.push_back(s.position);
    next += kPathStep;
  };
  while (!near.empty() && time < until && s.position.x() < away && s.position.x() < edge_x_) {
    note();
    s.position += 0.5 * kAirStep * s.velocity;
    turn(s.orientation, 0.5 * kAirStep * s.spin);
    push(s, p, near, wide, time + 0.5 * kAirStep, kAirStep);
    s.velocity.z() += kAirStep * gravity_;
    fell += kAirStep * gravity_;
    s.position += 0.5 * kAirStep * s.velocity;
    turn(s.orientation, 0.5 * kAirStep * s.spin);
    time += kAirStep;
  }
  end.gain = s.velocity.z() - v0 - fell;
  end.touched = std::abs(end.gain) > 1e-3;
  if (s.velocity.x() <= 0.0) {  // blown back: it never comes to the plate
    end.clearance = -edge_z_;
    end.y = s.position.y();
    return end;
  }
  const double left = (edge_x_ - s.position.x()) / s.velocity.x();
  const Vec3 there = s.position + left * s.velocity + 0.5 * left * left * gravity;
  if (keep_path)
    for (double t = 0.0; t < left; t += kPathStep)
      end.path.push_back(s.position + t * s.velocity + 0.5 * t * t * gravity);
  end.clearance = there.z() - edge_z_;
  end.y = there.y();
  return end;
}

double AirCoefficients::of(const FeedParticle& p) const {
  const double at = std::clamp((p.size() - small) / (large - small), 0.0, 1.0);
  return p.prototype->sharp ? sharp_small + at * (sharp_large - sharp_small)
                            : round_small + at * (round_large - round_small);
}

double AirCoefficients::widening(const FeedParticle& p, double half_radius) const {
  if (p.prototype->sharp || !(half_radius > 0.0)) return sharp_widening;
  return std::hypot(1.0,
                    round_spread * p.scale * std::sqrt(p.prototype->area / std::numbers::pi) / half_radius);
}

}  // namespace ejecta
