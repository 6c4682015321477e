#include "dem/particles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "base/stopwatch.hpp"
#include "dem/blocks.hpp"
#include "dem/rotation.hpp"
#include "dem/time_step.hpp"

namespace ejecta {
namespace {

constexpr int kBodyBlock = 512;   // bodies one thread moves at a time; sums are kept by block
constexpr double kSlowest = 0.1;  // m/s, impact speed the step is made for at least
constexpr double kMostPieces = 64.0;
constexpr double kMostGiven = 0.25;
constexpr double kSeveralBalls = 2.0;  // contacts a ball has of which only the deepest is looked at

void note_peak(ContactPeaks& p, double overlap, double force_squared, double dt) {
  if (!(force_squared > 0)) return;
  p.time += dt;
  p.overlap = std::max(p.overlap, overlap);
  if (force_squared > p.force * p.force) p.force = std::sqrt(force_squared);
}

}  // namespace

Particles::Particles(const Vec3& gravity, Materials materials, const ContactSpec& contact,
                     const Domain& domain)
    : gravity_(gravity), materials_(std::move(materials)), contact_(contact), domain_(domain) {}

bool Particles::moves(std::size_t n) const {
  const Body& b = bodies_[n];
  return b.motion != Motion::fixed && presence_[n] == Presence::here && time_ >= b.release_at * (1 - 1e-12);
}

double Particles::stable_dt() const {
  const int count = static_cast<int>(bodies_.size());
  struct Fastest {
    double centre = kSlowest;
    Farthest<double> point;  // m/s, of any point of a body
  };
  thread_local std::vector<Fastest> scratch;
  std::vector<Fastest>& blocks = scratch;
  blocks.assign(static_cast<std::size_t>(block_count(count, kBodyBlock)), {});
  for_each_block(count, kBodyBlock, [&](int block, int begin, int end) {
    Fastest& of = blocks[static_cast<std::size_t>(block)];
    for (std::size_t n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n) {
      if (presence_[n] != Presence::here) continue;
      const double speed = bodies_[n].velocity.norm();
      of.centre = std::max(of.centre, speed);
      of.point.note(speed + bodies_[n].angular_velocity.norm() * bodies_[n].shape.bounding_radius());
    }
  });
  Fastest all;
  for (const Fastest& of : blocks) {
    all.centre = std::max(all.centre, of.centre);
    all.point.note(of.point.second);
    all.point.note(of.point.first);
  }
  const double longest = passing_time(thinnest_, std::max(all.point.first + all.point.second, kSlowest));
  if (contact_.time_step) return std::min(*contact_.time_step, longest);
  return std::min(contact_.time_step_fraction * shortest_contact(all.centre), longest);
}

/// s, of bodies that meet at a speed, m/s; at most 1.
double Particles::shortest_contact(double speed) const {
  const auto same = [](const Body& a, const Body& b) {
    return a.motion == b.motion && a.material == b.material && a.mass == b.mass && a.shape.is(b.shape);
  };
  return -largest_of(static_cast<int>(bodies_.size()), kBodyBlock, -1.0, [&](std::size_t n) {
    const Body& b = bodies_[n];
    if (b.motion != Motion::free || (n > 0 && same(bodies_[n - 1], b))) return -1.0;
    return -contact_time(b, materials_, speed);
  });
}

/// Velocity Verlet (Swope et al. 1982, J. Chem. Phys. 76:637): half a kick, drift, new forces, half a kick.
/// The kick that ends a sub-step and the one that begins the next are one pass over the bodies.
void Particles::advance(double dt, std::span<const Load> loads) {
  if (!(dt > 0)) return;
  enter_and_leave();
  const int steps = std::max(1, static_cast<int>(std::ceil(dt / stable_dt() * (1 - 1e-12))));
  const double start = time_, step = dt / steps;
  note_leaps(step);
  pack_spheres();
  int left = pieces_of(step);
  double now = step / left;
  add_work(0.5 * now);
  move_bodies(0.0, now, loads);
  for (int n = 1; now > 0;) {
    find_contacts(now);
    time_ = start + dt * n / steps - --left * now;
    double next = now;
    if (left == 0) {
      left = pieces_of(step);
      next = n++ < steps ? step / left : 0.0;
    }
    move_bodies(now, next, loads);
    add_work(0.5 * (now + next));
    now = next;
  }
  unpack_spheres();
  require_paid_for();
}

/// Balls set no limit to the step (population.cpp, note_size): that they may have passed through each other
/// unseen is told at the end.
void Particles::note_leaps(double step) {
  if (bodies_.size() < 2) return;
  leap_ = largest_of(static_cast<int>(bodies_.size()), kBodyBlock, leap_, [&](std::size_t n) {
    if (presence_[n] != Presence::here || parts_.ball_count(static_cast<int>(n)) != 1) return 0.0;
    return 0.5 * step * bodies_[n].velocity.norm() / bodies_[n].shape.bounding_radius();
  });
}

/// What contacts have given beyond what they took comes from nowhere: of what went through them no more than
/// the errors of steps.
void Particles::require_paid_for() const {
  if (!(-contact_work_ > kMostGiven * exchanged_)) return;
  const auto fastest = std::max_element(bodies_.begin(), bodies_.end(), [](const Body& a, const Body& b) {
    return a.velocity.squaredNorm() < b.velocity.squaredNorm();
  });
  throw DivergedError(fmt::format(
      "contacts gave {:.3g} J more than they took; at t = {:.6g} s body \"{}\" moves at {:.4g} m/s. Bodies "
      "are dented "
      "deeper than they are thick: try a larger youngs_modulus, or a smaller contact.time_step_fraction (now "
      "{})",
      -contact_work_, time_, fastest->name, fastest->velocity.norm(), contact_.time_step_fraction));
}

int Particles::pieces_of(double step) const {
  if (contact_.time_step) return 1;
  return static_cast<int>(std::clamp(std::ceil(step * asked_rate_), 1.0, kMostPieces));
}

void Particles::release(std::size_t n) {
  Launch& launch = launches_[n];
  if (!launch.waiting) return;
  Body& b = bodies_[n];
  launch.waiting = false;
  b.velocity = b.course ? b.course->velocity(time_) : launch.velocity;
  b.angular_velocity = b.course ? b.course->spin(time_) : launch.spin;
  momentum_[n] = b.angular_momentum();
}

void Particles::pack_spheres() {
  spheres_.resize(bodies_.size());
  pushed_.resize(bodies_.size());
  packed_.resize(bodies_.size());
  for_each_block(static_cast<int>(bodies_.size()), kBodyBlock, [&](int, int begin, int end) {
    for (std::size_t n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n) {
      const Body& b = bodies_[n];
      if (b.motion == Motion::free && moves(n)) release(n);
      packed_[n] = b.motion == Motion::free && moves(n) && parts_.is_sphere(static_cast<int>(n));
      if (packed_[n])
        spheres_[n] = {vec4(b.velocity) + Vec4{0, 0, 0, 1 / b.mass},
                       vec4(momentum_[n]) + Vec4{0, 0, 0, 1 / b.inertia[0]},
                       __builtin_convertvector(vec4(b.position - listed_at_[n]), Vec4f), Vec4f{}};
    }
  });
}

void Particles::unpack_spheres() {
  for_each_block(static_cast<int>(bodies_.size()), kBodyBlock, [&](int, int begin, int end) {
    for (std::size_t n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n) {
      if (!packed_[n]) continue;
      const SphereState& s = spheres_[n];
      Body& b = bodies_[n];
      b.position = parts_.sphere_row(static_cast<int>(n)).centre();
      listed_at_[n] = b.position - vec3(__builtin_convertvector(s.moved, Vec4));
      b.velocity = vec3(s.velocity);
      momentum_[n] = vec3(s.momentum);
      b.angular_velocity = s.inverse_inertia() * momentum_[n];
      turn(b.orientation, vec3(__builtin_convertvector(s.turn, Vec4)));
    }
  });
}

Vec3 Particles::acceleration(std::size_t n, std::span<const Load> loads) const {
  Vec3 force = force_[n];
  if (!loads.empty()) force += loads[n].force;
  return gravity_ + force / bodies_[n].mass;
}

Vec3 Particles::torque_on(std::size_t n, std::span<const Load> loads) const {
  return loads.empty() ? torque_[n] : Vec3(torque_[n] + loads[n].torque);
}

void Particles::move_bodies(double kicked, double drifted, std::span<const Load> loads) {
  ScopedTimer timer(times_.motion);
  const int count = static_cast<int>(bodies_.size());
  const bool kick = kicked > 0, drift = drifted > 0;
  const Vec4 gravity = vec4(gravity_);
  block_moved_.resize(static_cast<std::size_t>(block_count(count, kBodyBlock)));
  block_work_.resize(block_moved_.size());
  for_each_block(count, kBodyBlock, [&](int block, int begin, int end) {
    Work work;
    Vec4 by_contacts{};
    Farthest<float> spheres;  // m2
    Farthest<double> others;  // m
    for (int i = begin; i < end; ++i) {
      const std::size_t n = static_cast<std::size_t>(i);
      if (packed_[n]) {
        SphereState& s = spheres_[n];
        BallRow& row = parts_.sphere_row(i);
        Push push{gravity, {}, {}, {}};
        if (!loads.empty()) {
          push.acceleration += s.inverse_mass() * vec4(loads[n].force);
          push.twist = vec4(loads[n].torque);
        }
        // Forces lie in memory only where solids push and between calls of advance().
        if (!kick || pushed_[n]) {
          push.force = vec4(force_[n]);
          push.torque = vec4(torque_[n]);
          force_[n].setZero();
          torque_[n].setZero();
          pushed_[n] = 0;
        }
        if (kick) {
          const double half = balls_.gather(parts_.first_ball(i), row.radius, push.force, push.torque);
          note_peak(peaks_[n], 2 * half, dot(push.force, push.force), kicked);
          by_contacts += kick_sphere(s, push, kicked);
          const double swiftest = materials_.swiftest(static_cast<int>(row.material)) * s.inverse_mass();
          work.asked = std::max(work.asked, swiftest * swiftest * row.radius * half);
          if (!loads.empty())
            work.from_outside += loads[n].force.dot(vec3(s.velocity)) +
                                 loads[n].torque.dot(s.inverse_inertia() * vec3(s.momentum));
        }
        if (drift) {
          spheres.note(drift_sphere(s, row, push, drifted));
        } else {
          force_[n] = vec3(push.force);
          torque_[n] = vec3(push.torque);
        }
      } else {
        if (kick) kick_body(i, loads, kicked, work);
        if (drift) others.note(drift_body(i, loads, drifted, work));
      }
    }
    work.into_contacts -= (by_contacts[0] + by_contacts[1]) + by_contacts[2];
    others.note(std::sqrt(spheres.second));
    others.note(std::sqrt(spheres.first));
    others.sum += spheres.sum;
    block_moved_[static_cast<std::size_t>(block)] = others;
    block_work_[static_cast<std::size_t>(block)] = work;
  });
  for (const Work& work : block_work_) outer_work_ += work.driven;
  if (!kick) return;
  // With velocities at the whole step, half of this power over dt before it and half after is exactly the
  // change of kinetic energy.
  const double by_walls = balls_.wall_power() + solids_.wall_power();
  power_ = {by_walls, by_walls};
  double asked = 0.0;
  for (const Work& work : block_work_) {
    power_.into_contacts += work.into_contacts;
    power_.from_outside += work.from_outside;
    asked = std::max(asked, work.asked);
  }
  asked_rate_ = std::max(std::sqrt(kSeveralBalls * std::sqrt(2.0 * asked)), solids_.asked_rate());
}

/// Returns how far a part of the body may have moved since the listing, m.
double Particles::drift_body(int index, std::span<const Load> loads, double dt, Work& work) {
  const std::size_t n = static_cast<std::size_t>(index);
  Body& b = bodies_[n];
  double moved = 0.0;
  if (moves(n) && b.course) {
    work.driven -= b.kinetic_energy();  // with what kick_body adds: the change
    release(n);
    b.position += b.course->way(time_, dt);
    b.course->turn(b.orientation, time_, dt);
    velocity_[n] = b.course->velocity(time_ + dt);
    spin_[n] = b.course->spin(time_ + dt);
    turned_[n] += dt * std::max(b.angular_velocity.norm(), spin_[n].norm()) * parts_.arm(index);
    moved = (b.position - listed_at_[n]).norm() + turned_[n];
  } else if (moves(n)) {
    release(n);
    const Vec3 kick = 0.5 * dt * acceleration(n, loads), twist = 0.5 * dt * torque_on(n, loads);
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
  Farthest<double> moved;
  for (const Farthest<double>& block : block_moved_) {
    moved.note(block.second);
    moved.note(block.first);
    moved.sum += block.sum;
  }
  if (!(moved.sum < std::numeric_limits<double>::infinity())) throw_diverged();
  if (relist_ || moved.first + moved.second > skin_) list_candidates(dt);
  {
    ScopedTimer timer(times_.balls);
    balls_.compute(parts_, materials_, domain_, dt);
  }
  ScopedTimer timer(times_.solids);
  solids_.compute(parts_, bodies_, walls_, materials_, domain_, velocity_, spin_, dt);
  collect_solids();
}

void Particles::throw_diverged() const {
  for (std::size_t n = 0; n < bodies_.size(); ++n) {
    const Body& b = bodies_[n];
    if (!(packed_[n] ? parts_.row(parts_.first_ball(static_cast<int>(n))).centre() : b.position)
             .allFinite() ||
        !b.orientation.coeffs().allFinite())
      throw DivergedError(
          fmt::format("the motion of body \"{}\" became no number at t = {:.6g} s; try a smaller "
                      "contact.time_step_fraction (now {}) or check the loads on it",
                      b.name, time_, contact_.time_step_fraction));
  }
  throw DivergedError(fmt::format("a body left the realm of numbers at t = {:.6g} s", time_));
}

void Particles::list_candidates(double dt) {
  ScopedTimer timer(times_.listing);
  ++lists_;
  const double fastest = largest_of(static_cast<int>(bodies_.size()), kBodyBlock, 0.0, [&](std::size_t n) {
    if (packed_[n]) {
      spheres_[n].moved = Vec4f{};
      return vec3(spheres_[n].velocity).norm();
    }
    listed_at_[n] = bodies_[n].position;
    turned_[n] = 0.0;
    return velocity_[n].norm() + spin_[n].norm() * parts_.arm(static_cast<int>(n));
  });
  // A wider skin costs a look at more pairs in every step, in proportion; a narrower one new lists more
  // often, in inverse proportion. The cheapest, with the factor measured on settling spheres, is
  const double smallest = bodies_.empty() ? 0.0 : smallest_;
  skin_ = std::clamp(2.8 * std::sqrt(fastest * dt * smallest), 0.01 * smallest, smallest);
  relist_ = false;
  search_.find(parts_, bodies_, walls_, domain_, skin_, &balls_);
  note_friction();
  balls_.set_pairs(search_.balls(), search_.planes(), parts_);
  solids_.set_pairs(search_.solids(), fresh_);
  pass_friction_on();
  if (std::find(fresh_.begin(), fresh_.end(), true) == fresh_.end()) return;
  balls_.note_births(fresh_, parts_, domain_, dt);
  std::fill(fresh_.begin(), fresh_.end(), false);
}

void Particles::note_friction() {
  friction_.clear();
  if (planes_.size() == walls_.size()) return;  // no surfaces
  for (const SolidPair& p : solids_.pairs()) {
    const ContactHistory& h = p.history;
    if (p.b.kind != PartKind::wall_triangle) continue;
    const Surface& surface = *walls_[static_cast<std::size_t>(p.b.index)].surface;
    if (h.touched())
      friction_.push_back({p.a.index,
                           p.b.index,
                           Vec3(h.normal.x, h.normal.y, h.normal.z),
                           {h.slip.x, h.slip.y, h.slip.z, h.roll.x, h.roll.y, h.roll.z},
                           false,
                           0.0,
                           h.dent});
    else if (h.side < 0 && !surface.two_sided())  // on its way through from behind, which leaves no dent
      friction_.push_back({.ball = p.a.index,
                           .wall = p.b.index,
                           .dent = 0.0,
                           .region = surface.triangles()[static_cast<std::size_t>(p.b.solid)].region});
  }
  for (int n = 0; n < balls_.pair_count(); ++n) {
    const auto [ball, plane] = balls_.pair(n);
    if (plane >= 0 || !(balls_.row(n).half_overlap > 0)) continue;
    const WallPlane& w = planes_[static_cast<std::size_t>(-1 - plane)];
    if (!walls_[static_cast<std::size_t>(w.wall)].is_plane)
      friction_.push_back({ball, w.wall, w.normal, balls_.friction(n), true, balls_.energy(n)});
  }
}

void Particles::pass_friction_on() {
  for (const Friction& f : friction_) {
    const Wall& wall = walls_[static_cast<std::size_t>(f.wall)];
    const int regions = static_cast<int>(wall.surface->regions().size());
    const int from = wall.first_plane + 2 * std::max(0, f.region),
              to = f.region < 0 ? wall.first_plane + 2 * regions : from + 2;
    const int as_plane = balls_.find_plane(f.ball, from, to);
    if (f.plane) {
      if (as_plane < 0) solids_.hand_over(f.ball, f.wall, f.normal, f.history, f.energy);
    } else if (as_plane >= 0 && balls_.friction(as_plane) == std::array<double, 6>{}) {
      balls_.set_friction(as_plane, f.history);
      if (f.dent < 1) balls_.set_dent(as_plane, f.dent, parts_, domain_);
    }
  }
}

/// Forces of contacts in which walls and polytopes take part, body by body in the order of the contacts.
void Particles::collect_solids() {
  solids_.gather([&](int body, const Vec3& force, const Vec3& moment, const Vec3& point, const Touch& touch) {
    const std::size_t n = static_cast<std::size_t>(body);
    // Of a part that is swallowed whole the vector area is next to nothing.
    const double deep = touch.thickness > 0 ? touch.thickness : touch.overlap;
    peaks_[n].overlap = std::max(peaks_[n].overlap, std::min(deep, 2 * bodies_[n].shape.bounding_radius()));
    const Vec3 centre = packed_[n] ? parts_.sphere_row(body).centre() : bodies_[n].position;
    force_[n] += force;
    torque_[n] += (point - centre).cross(force) + moment;
    pushed_[n] = 1;
  });
}

void Particles::kick_body(int index, std::span<const Load> loads, double dt, Work& work) {
  const std::size_t n = static_cast<std::size_t>(index);
  Body& b = bodies_[n];
  double deepest = 0.0, dents = 0.0;  // m; sum of root(radius x overlap / 2)
  for (int ball = parts_.first_ball(index); ball < parts_.first_ball(index + 1); ++ball) {
    Vec4 force{}, torque{};
    const BallRow& row = parts_.row(ball);
    const double half = balls_.gather(ball, row.radius, force, torque);
    deepest = std::max(deepest, half);
    dents += std::sqrt(row.radius * half);
    force_[n] += vec3(force);
    torque_[n] += vec3(torque) + (row.centre() - b.position).cross(vec3(force));
  }
  note_peak(peaks_[n], 2 * deepest, force_[n].squaredNorm(), dt);
  if (b.motion == Motion::fixed || launches_[n].waiting || presence_[n] != Presence::here) return;
  const bool pushed = b.motion == Motion::free;
  if (pushed) {
    const double swiftest = materials_.swiftest(b.material) * dents / b.mass;
    work.asked = std::max(work.asked, swiftest * swiftest);
    b.velocity += 0.5 * dt * acceleration(n, loads);
    momentum_[n] += 0.5 * dt * torque_on(n, loads);
    b.angular_velocity = angular_velocity(b.orientation, momentum_[n], b.inertia);
  } else {
    b.velocity = b.course->velocity(time_);
    b.angular_velocity = b.course->spin(time_);
    momentum_[n] = b.angular_momentum();
    work.driven += b.kinetic_energy();
  }
  const double by_contacts = force_[n].dot(b.velocity) + torque_[n].dot(b.angular_velocity);
  work.into_contacts -= by_contacts;
  if (!pushed) work.from_outside -= by_contacts;  // what keeps a prescribed body on its course
  if (pushed && !loads.empty())
    work.from_outside += loads[n].force.dot(b.velocity) + loads[n].torque.dot(b.angular_velocity);
}

void Particles::add_work(double dt) {
  contact_work_ += dt * power_.into_contacts;
  exchanged_ += dt * std::abs(power_.into_contacts);
  outer_work_ += dt * power_.from_outside;
}

}  // namespace ejecta
