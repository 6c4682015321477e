#include "dem/particles.hpp"

#include <algorithm>
#include <cmath>

#include "dem/rotation.hpp"

namespace ejecta {

int Particles::add(Body body) {
  momentum_.push_back(body.angular_momentum());
  bodies_.push_back(std::move(body));
  return static_cast<int>(bodies_.size()) - 1;
}

void Particles::remove(int index) {
  bodies_.erase(bodies_.begin() + index);
  momentum_.erase(momentum_.begin() + index);
}

void Particles::place(int index, const Vec3& position, const Quat& orientation, const Vec3& velocity,
                      const Vec3& angular_velocity) {
  Body& b = bodies_[static_cast<std::size_t>(index)];
  b.position = position;
  b.orientation = orientation;
  b.velocity = velocity;
  b.angular_velocity = angular_velocity;
  momentum_[static_cast<std::size_t>(index)] = b.angular_momentum();
}

double Particles::stable_dt() const { return largest_step_; }

void Particles::advance(double dt, std::span<const Load> loads) {
  const int steps = std::max(1, static_cast<int>(std::ceil(dt / largest_step_ * (1 - 1e-12))));
  const double start = time_;
  for (int n = 0; n < steps; ++n) {
    substep(dt / steps, loads);
    time_ = start + dt * (n + 1) / steps;
  }
}

void Particles::substep(double dt, std::span<const Load> loads) {
  for (std::size_t n = 0; n < bodies_.size(); ++n) {
    Body& b = bodies_[n];
    if (b.motion == Motion::fixed || time_ < b.release_at * (1 - 1e-12)) continue;
    const bool is_free = b.motion == Motion::free;
    const Load load = is_free && !loads.empty() ? loads[n] : Load{};
    const Vec3 kick = is_free ? Vec3(0.5 * dt * (gravity_ + load.force / b.mass)) : Vec3(0, 0, 0);
    b.velocity += kick;
    momentum_[n] += 0.5 * dt * load.torque;
    b.position += dt * b.velocity;
    rotate_free(b.orientation, momentum_[n], b.inertia, dt);
    b.velocity += kick;
    momentum_[n] += 0.5 * dt * load.torque;
    b.angular_velocity = angular_velocity(b.orientation, momentum_[n], b.inertia);
  }
}

DemEnergy Particles::energy() const {
  DemEnergy e;
  for (const Body& b : bodies_) {
    e.kinetic += b.kinetic_energy();
    e.potential -= b.mass * gravity_.dot(b.position);
  }
  return e;
}

std::vector<double> Particles::state() const {
  std::vector<double> s{time_};
  for (std::size_t n = 0; n < bodies_.size(); ++n) {
    const Body& b = bodies_[n];
    s.insert(s.end(), b.position.data(), b.position.data() + 3);
    s.insert(s.end(), b.orientation.coeffs().data(), b.orientation.coeffs().data() + 4);
    s.insert(s.end(), b.velocity.data(), b.velocity.data() + 3);
    s.insert(s.end(), momentum_[n].data(), momentum_[n].data() + 3);
  }
  return s;
}

void Particles::restore(std::span<const double> s) {
  time_ = s[0];
  for (std::size_t n = 0; n < bodies_.size(); ++n) {
    const double* at = s.data() + 1 + 13 * n;
    Body& b = bodies_[n];
    b.position = Vec3(at);
    b.orientation.coeffs() = Eigen::Vector4d(at + 3);
    b.velocity = Vec3(at + 7);
    momentum_[n] = Vec3(at + 10);
    b.angular_velocity = angular_velocity(b.orientation, momentum_[n], b.inertia);
  }
}

Particles make_particles(const Case& config) {
  Particles particles(config.environment.gravity);
  for (const BodySpec& spec : config.bodies) particles.add(make_body(spec, config));
  return particles;
}

}  // namespace ejecta
