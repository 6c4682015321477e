#include "dem/particles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "dem/blocks.hpp"
#include "dem/rotation.hpp"
#include "dem/time_step.hpp"

namespace ejecta {
namespace {

constexpr int kBlock = 512;             // bodies one thread moves at a time; sums are kept by block
constexpr double kSlowest = 0.1;        // m/s, impact speed the step is made for at least
constexpr int kStepsBetweenLists = 20;  // aimed at when the skin is chosen

Vec4 load_torque(std::size_t n, std::span<const Load> loads) {
  return loads.empty() ? Vec4{} : vec4(loads[n].torque);
}

void note_peak(ContactPeaks& p, double overlap, double force_squared, double dt) {
  if (!(force_squared > 0)) return;
  p.time += dt;
  p.overlap = std::max(p.overlap, overlap);
  if (force_squared > p.force * p.force) p.force = std::sqrt(force_squared);
}

}  // namespace

Particles::Particles(const Vec3& gravity, Materials materials, const ContactSpec& contact)
    : gravity_(gravity), materials_(std::move(materials)), contact_(contact) {}

bool Particles::moves(const Body& body) const {
  return body.motion != Motion::fixed && time_ >= body.release_at * (1 - 1e-12);
}

double Particles::stable_dt() const {
  if (contact_.time_step) return *contact_.time_step;
  double fastest = kSlowest;
  for (const Body& b : bodies_) fastest = std::max(fastest, b.velocity.norm());
  double time = 1.0;
  for (const Body& b : bodies_)
    if (b.motion == Motion::free) time = std::min(time, contact_time(b, materials_, fastest));
  return contact_.time_step_fraction * time;
}

void Particles::advance(double dt, std::span<const Load> loads) {
  if (!(dt > 0)) return;
  const int steps = std::max(1, static_cast<int>(std::ceil(dt / stable_dt() * (1 - 1e-12))));
  const double start = time_;
  pack_spheres();
  for (int n = 0; n < steps; ++n) {
    substep(dt / steps, loads);
    time_ = start + dt * (n + 1) / steps;
  }
  unpack_spheres();
}

void Particles::release(std::size_t n) {
  Launch& launch = launches_[n];
  if (!launch.waiting) return;
  launch.waiting = false;
  bodies_[n].velocity = launch.velocity;
  bodies_[n].angular_velocity = launch.spin;
  momentum_[n] = bodies_[n].angular_momentum();
}

void Particles::pack_spheres() {
  spheres_.resize(bodies_.size());
  packed_.resize(bodies_.size());
  for (std::size_t n = 0; n < bodies_.size(); ++n) {
    const Body& b = bodies_[n];
    if (moves(b)) release(n);
    packed_[n] = b.motion == Motion::free && moves(b) && parts_.is_sphere(static_cast<int>(n));
    if (packed_[n])
      spheres_[n] = {vec4(b.position), vec4(b.velocity), vec4(momentum_[n]),
                     vec4(force_[n]),  vec4(torque_[n]), vec4(listed_at_[n]),
                     Vec4{},           1 / b.mass,       1 / b.inertia[0]};
  }
}

void Particles::unpack_spheres() {
  for (std::size_t n = 0; n < bodies_.size(); ++n) {
    if (!packed_[n]) continue;
    const SphereState& s = spheres_[n];
    Body& b = bodies_[n];
    b.position = vec3(s.position);
    b.velocity = vec3(s.velocity);
    b.angular_velocity = s.inverse_inertia * vec3(s.momentum);
    turn(b.orientation, vec3(s.turn));
    momentum_[n] = vec3(s.momentum);
    force_[n] = vec3(s.force);
    torque_[n] = vec3(s.torque);
    listed_at_[n] = vec3(s.listed_at);
  }
}

Vec3 Particles::acceleration(std::size_t n, std::span<const Load> loads) const {
  Vec3 force = force_[n];
  if (!loads.empty()) force += loads[n].force;
  return gravity_ + force / bodies_[n].mass;
}

Vec3 Particles::torque_on(std::size_t n, std::span<const Load> loads) const {
  return loads.empty() ? torque_[n] : Vec3(torque_[n] + loads[n].torque);
}

/// Velocity Verlet (Swope et al. 1982, J. Chem. Phys. 76:637): half a kick, drift, new forces, half a kick.
void Particles::substep(double dt, std::span<const Load> loads) {
  add_work(0.5 * dt);
  drift(dt, loads);
  find_contacts(dt);
  kick(dt, loads);
}

void Particles::drift(double dt, std::span<const Load> loads) {
  const int count = static_cast<int>(bodies_.size());
  const Vec4 gravity = vec4(gravity_);
  block_moved_.resize(static_cast<std::size_t>(block_count(count, kBlock)));
  for_each_block(count, kBlock, [&](int block, int begin, int end) {
    double spheres = 0.0, others = 0.0;  // farthest moves: m2, m
    for (int i = begin; i < end; ++i) {
      const std::size_t n = static_cast<std::size_t>(i);
      if (packed_[n]) {
        SphereState& s = spheres_[n];
        const Vec4 push = loads.empty() ? gravity : gravity + s.inverse_mass * vec4(loads[n].force);
        const double moved = drift_sphere(s, parts_.sphere_row(i), push, load_torque(n, loads), dt);
        if (!(moved <= spheres)) spheres = moved;  // keeps NaN
      } else {
        const double moved = drift_body(i, loads, dt);
        if (!(moved <= others)) others = moved;
      }
    }
    const double moved = std::sqrt(spheres);
    block_moved_[static_cast<std::size_t>(block)] = moved <= others ? others : moved;
  });
}

/// Returns how far a part of the body may have moved since the listing, m.
double Particles::drift_body(int index, std::span<const Load> loads, double dt) {
  const std::size_t n = static_cast<std::size_t>(index);
  Body& b = bodies_[n];
  double moved = 0.0;
  if (moves(b)) {
    release(n);
    const bool pushed = b.motion == Motion::free;
    const Vec3 kick = pushed ? Vec3(0.5 * dt * acceleration(n, loads)) : Vec3(0, 0, 0);
    const Vec3 twist = pushed ? Vec3(0.5 * dt * torque_on(n, loads)) : Vec3(0, 0, 0);
    b.velocity += kick;
    momentum_[n] += twist;
    b.position += dt * b.velocity;
    rotate_free(b.orientation, momentum_[n], b.inertia, dt);
    // Damping and friction need velocities at the whole step: extrapolated, to keep the second order.
    velocity_[n] = b.velocity + kick;
    spin_[n] = angular_velocity(b.orientation, momentum_[n] + twist, b.inertia);
    turned_[n] += dt * spin_[n].norm() * parts_.arm(index);
    moved = (b.position - listed_at_[n]).norm() + turned_[n];
  } else {
    velocity_[n].setZero();
    spin_[n].setZero();
  }
  force_[n].setZero();
  torque_[n].setZero();
  parts_.update(index, b, velocity_[n], spin_[n]);
  return moved;
}

void Particles::find_contacts(double dt) {
  double moved = 0.0;
  for (const double block : block_moved_)
    if (!(block <= moved)) moved = block;
  if (!(moved < std::numeric_limits<double>::infinity())) throw_diverged();
  if (relist_ || 2 * moved > skin_) list_candidates(dt);
  balls_.compute(parts_, materials_, dt);
  solids_.compute(parts_, bodies_, walls_, materials_, velocity_, spin_, dt);
}

void Particles::throw_diverged() const {
  for (std::size_t n = 0; n < bodies_.size(); ++n) {
    const Body& b = bodies_[n];
    if (!(packed_[n] ? vec3(spheres_[n].position) : b.position).allFinite() ||
        !b.orientation.coeffs().allFinite())
      throw DivergedError(
          fmt::format("the motion of body \"{}\" became no number at t = {:.6g} s; try a smaller "
                      "contact.time_step_fraction (now {}) or check the loads on it",
                      b.name, time_, contact_.time_step_fraction));
  }
  throw DivergedError(fmt::format("a body left the realm of numbers at t = {:.6g} s", time_));
}

void Particles::list_candidates(double dt) {
  double fastest = 0.0, smallest = std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n < bodies_.size(); ++n) {
    if (packed_[n]) {
      SphereState& s = spheres_[n];
      s.listed_at = s.position;
      fastest = std::max(fastest, std::sqrt(dot(s.velocity, s.velocity)));
    } else {
      listed_at_[n] = bodies_[n].position;
      turned_[n] = 0.0;
      fastest = std::max(fastest, velocity_[n].norm() + spin_[n].norm() * parts_.arm(static_cast<int>(n)));
    }
    smallest = std::min(smallest, bodies_[n].shape.bounding_radius());
  }
  skin_ = std::clamp(2 * kStepsBetweenLists * fastest * dt, 0.1 * smallest, smallest);
  relist_ = false;
  Candidates candidates = search_.find(parts_, bodies_, walls_, skin_);
  balls_.set_pairs(candidates.balls, parts_.ball_count());
  solids_.set_pairs(std::move(candidates.solids));
}

void Particles::kick(double dt, std::span<const Load> loads) {
  const int count = static_cast<int>(bodies_.size());
  const Vec4 gravity = vec4(gravity_);
  block_work_.resize(static_cast<std::size_t>(block_count(count, kBlock)));
  solids_.gather([&](int body, const Vec3& force, const Vec3& moment, const Touch& touch) {
    const std::size_t n = static_cast<std::size_t>(body);
    const Vec3& point = touch.point;
    peaks_[n].overlap = std::max(peaks_[n].overlap, touch.thickness > 0 ? touch.thickness : touch.overlap);
    if (packed_[n]) {
      spheres_[n].force += vec4(force);
      spheres_[n].torque += vec4((point - vec3(spheres_[n].position)).cross(force) + moment);
    } else {
      force_[n] += force;
      torque_[n] += (point - bodies_[n].position).cross(force) + moment;
    }
  });
  // With velocities at the whole step, half of this power over dt before it and half after is exactly the
  // change of kinetic energy.
  for_each_block(count, kBlock, [&](int block, int begin, int end) {
    Work work;
    for (int i = begin; i < end; ++i) {
      const std::size_t n = static_cast<std::size_t>(i);
      if (packed_[n]) {
        SphereState& s = spheres_[n];
        const int ball = parts_.first_ball(i);
        const double half = balls_.gather(ball, parts_.row(ball).radius, s.force, s.torque);
        note_peak(peaks_[n], 2 * half, dot(s.force, s.force), dt);
        const Vec4 push = loads.empty() ? gravity : gravity + s.inverse_mass * vec4(loads[n].force);
        work.into_contacts -= kick_sphere(s, push, load_torque(n, loads), dt);
        if (!loads.empty())
          work.from_outside += loads[n].force.dot(vec3(s.velocity)) +
                               loads[n].torque.dot(s.inverse_inertia * vec3(s.momentum));
      } else {
        kick_body(i, loads, dt, work);
      }
    }
    block_work_[static_cast<std::size_t>(block)] = work;
  });
  power_ = {solids_.wall_power(), solids_.wall_power()};
  for (const Work& work : block_work_) {
    power_.into_contacts += work.into_contacts;
    power_.from_outside += work.from_outside;
  }
  add_work(0.5 * dt);
}

void Particles::kick_body(int index, std::span<const Load> loads, double dt, Work& work) {
  const std::size_t n = static_cast<std::size_t>(index);
  Body& b = bodies_[n];
  double deepest = 0.0;
  for (int ball = parts_.first_ball(index); ball < parts_.first_ball(index + 1); ++ball) {
    Vec4 force{}, torque{};
    const BallRow& row = parts_.row(ball);
    deepest = std::max(deepest, balls_.gather(ball, row.radius, force, torque));
    force_[n] += vec3(force);
    torque_[n] += vec3(torque) + (row.centre() - b.position).cross(vec3(force));
  }
  note_peak(peaks_[n], 2 * deepest, force_[n].squaredNorm(), dt);
  if (!moves(b)) return;
  const bool pushed = b.motion == Motion::free;
  if (pushed) {
    b.velocity += 0.5 * dt * acceleration(n, loads);
    momentum_[n] += 0.5 * dt * torque_on(n, loads);
  }
  b.angular_velocity = angular_velocity(b.orientation, momentum_[n], b.inertia);
  const double by_contacts = force_[n].dot(b.velocity) + torque_[n].dot(b.angular_velocity);
  work.into_contacts -= by_contacts;
  if (!pushed) work.from_outside -= by_contacts;  // what keeps a prescribed body on its course
  if (pushed && !loads.empty())
    work.from_outside += loads[n].force.dot(b.velocity) + loads[n].torque.dot(b.angular_velocity);
}

void Particles::add_work(double dt) {
  contact_work_ += dt * power_.into_contacts;
  outer_work_ += dt * power_.from_outside;
}

DemEnergy Particles::energy() const {
  DemEnergy e;
  for (const Body& b : bodies_) {
    e.kinetic += b.kinetic_energy();
    if (b.motion == Motion::free) e.potential -= b.mass * gravity_.dot(b.position);
  }
  e.elastic = balls_.elastic() + solids_.elastic();
  e.dissipated = contact_work_ - e.elastic;
  e.work = outer_work_;
  return e;
}

std::vector<ContactRecord> Particles::contacts() const {
  std::vector<ContactRecord> records;
  for (int n = 0; n < balls_.pair_count(); ++n) {
    const auto& row = balls_.row(n);
    if (!(row.half_overlap > 0)) continue;
    const auto [a, b] = balls_.pair(n);
    const BallRow &ball = parts_.row(a), &other = parts_.row(b);
    const Vec3 normal = (ball.centre() - other.centre()).normalized();
    records.push_back({parts_.body_of_ball(a), parts_.body_of_ball(b),
                       ball.centre() - (ball.radius - row.half_overlap) * normal, normal,
                       Vec3(row.fx, row.fy, row.fz), 2 * row.half_overlap});
  }
  for (const SolidPair& p : solids_.pairs())
    if (p.touch.overlap > 0)
      records.push_back({p.body_a, p.body_b >= 0 ? p.body_b : -1 - p.b.index, p.touch.point, p.touch.normal,
                         p.force, p.touch.overlap});
  return records;
}

}  // namespace ejecta
