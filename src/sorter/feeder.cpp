#include "sorter/feeder.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.hpp"
#include "base/thread_budget.hpp"
#include "dem/particles.hpp"
#include "dem/rotation.hpp"
#include "dem/time_step.hpp"

namespace ejecta {
namespace {

constexpr double kLook = 1e-3;        ///< s, between two looks at who came, landed, rests
constexpr double kStill = 2e-3;       ///< m/s: what moves less on the belt, for kStillFor, rests
constexpr double kStillFor = 20e-3;   ///< s
constexpr double kRideOver = 1.5;     ///< particles ride this many of the largest radius before the lip
constexpr double kTrayThick = 10e-3;  ///< m
constexpr double kSmallest =
    1e-3;  ///< of all: sub-steps are those of the size of which only so many are smaller
constexpr double kFaster = 1.5;  ///< than any should be

Wall plane(const Vec3& normal, double offset, const Vec3& velocity) {
  Wall w;
  w.normal = normal;
  w.offset = offset;
  w.velocity = velocity;
  return w;
}

}  // namespace

double fall_time(const Case& c) {
  return std::sqrt(2.0 * c.feed.lip_height / std::abs(c.environment.gravity.z()));
}

Feeder::Feeder(const Case& c, const std::vector<ParticleClass>& classes)
    : case_(c),
      classes_(&classes),
      camera_x_(c.feed.lip_distance),
      end_x_(c.feed.lip_distance + c.camera.distance - c.launch.drop_distance) {
  const Materials materials(c);
  const double v = c.launch.belt_speed, u = c.feed.lip_speed, fall = fall_time(c),
               impact = std::hypot(v, c.environment.gravity.z() * fall);
  double radius = 0.0, time = 1.0, thinnest = kTrayThick;
  for (const ParticleClass& k : classes)
    for (const Prototype& p : k.prototypes()) {
      FeedParticle smallest;
      smallest.prototype = &p;
      smallest.scale = k.size_at(kSmallest) / p.size;
      smallest.mass = k.mass_of(p, smallest.scale);
      time = std::min(time, contact_time(body_of(smallest, k.spec()), materials, impact));
      radius = std::max(radius, p.shape.bounding_radius() * k.size_at(1.0 - 1e-6) / p.size);
      thinnest = std::min(thinnest, smallest.scale * p.shape.smallest_feature());
    }
  largest_ = radius;
  const bool asked = c.given.contains("contact.time_step_fraction");
  step_ = c.contact.time_step.value_or((asked ? c.contact.time_step_fraction : kSorterStepFraction) * time);
  // Fallen, two of them spun by the belt at its speed: by what dem would else divide the steps of all.
  step_ = std::min(step_, passing_time(thinnest, 2.0 * kFaster * (impact + v)));
  // Whoever slides has of the belt's friction what the belt bears of it: the fall's momentum at once, then
  // its weight.
  const double a = materials.pair(0, 0).friction * std::abs(c.environment.gravity.z()),
               left = camera_x_ - u * fall, landed = std::min(v, u + a * fall),
               slip = (v * v - landed * landed) / (2.0 * a);
  delay_ = fall;
  if (u >= v) delay_ += left / v;
  else if (slip < left) delay_ += (v - landed) / a + (left - slip) / v;
  else delay_ += (std::sqrt(landed * landed + 2.0 * a * left) - landed) / a;
}

double Feeder::early() const {
  return delay_ - camera_x_ / std::max(case_.launch.belt_speed, case_.feed.lip_speed);
}

ContactSpec Feeder::contacts() const {
  ContactSpec contact = case_.contact;
  contact.time_step =
      kLook / std::ceil(kLook / step_);  // one for all: what nobody touches moves the same anywhere
  return contact;
}

/// Who is where, of the particles of a run.
struct Feeder::Scene {
  struct Rider {
    std::size_t which = 0;  ///< of the particles
    double still = 0.0;     ///< s, for which it has not moved on the belt
    bool seen = false;      ///< by the camera
    double seen_at = 0.0;   ///< s
    Quat seen_turn = Quat::Identity();
  };
  Particles dem;
  std::vector<Rider> riders;  ///< in the order of the bodies
};

std::vector<FeedParticle> Feeder::run(std::vector<FeedParticle> tray, std::size_t wanted) const {
  if (wanted == 0) return tray;
  const ThreadBudget one(1);  // scenes are computed side by side
  const Materials materials(case_);
  const double v = case_.launch.belt_speed, u = case_.feed.lip_speed, half = 0.5 * case_.sorter.belt_width,
               ride = kRideOver * largest_, drop = case_.launch.drop_distance;
  Scene s{.dem = Particles(Vec3(0, 0, case_.environment.gravity.z()), materials, contacts()), .riders = {}};
  s.dem.add(plane(Vec3::UnitZ(), 0.0, Vec3(v, 0, 0)));
  s.dem.add(plane(Vec3::UnitY(), -half, Vec3::Zero()));
  s.dem.add(plane(-Vec3::UnitY(), -half, Vec3::Zero()));
  WallSpec lip{.name = "tray", .kind = WallKind::box};
  lip.size = Vec3(2.0 * (ride + largest_), 2.0 * half, kTrayThick);
  lip.point = Vec3(-0.5 * lip.size.x(), 0.0, case_.feed.lip_height - 0.5 * kTrayThick);
  lip.velocity = Vec3(u, 0, 0);
  s.dem.add(make_wall(lip, materials, ""));

  std::vector<std::size_t> order(tray.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return tray[a].x < tray[b].x; });
  const auto enters = [&](std::size_t n) { return (tray[n].x - ride) / u; };
  std::vector<FeedParticle> out = tray;
  std::size_t next = 0, coming = wanted;
  const double longest =
      delay_ + 2.0 * kLate + (end_x_ - camera_x_) / v;  // s, from the lip to the belt's end
  const auto come_never = [&](const FeedParticle& p) {
    throw InputError(fmt::format(
        "a particle of \"{}\" comes to the camera more than {:.2g} s after the others: it rolls or slips "
        "without end\n"
        "  expected: more material.friction or rolling_friction, or a smaller sorter.feed.lip_distance",
        (*classes_)[static_cast<std::size_t>(p.kind)].spec().name, kLate));
  };
  const auto leave = [&](std::size_t rider, double time, double vx) {
    const Scene::Rider& r = s.riders[rider];
    const Body& b = s.dem.bodies()[rider];
    FeedParticle& p = out[r.which];
    const bool rests = vx == v;
    const double seen_at = r.seen ? r.seen_at : time + (camera_x_ - b.position.x()) / vx;
    const Quat seen_turn = r.seen ? r.seen_turn : b.orientation;
    const double y = r.seen ? p.y : b.position.y();
    if (seen_at > tray[r.which].x / u + delay_ + kLate) come_never(p);  // no cell would look for it
    p.x = v * (seen_at - delay_);
    p.beside += b.position.y() - y;
    p.y = y;
    p.yaw = 0.0;
    p.tilt = seen_turn * p.prototype->resting.conjugate();
    p.turned = r.seen ? b.orientation * seen_turn.conjugate() : Quat::Identity();
    if (r.seen) {
      const double at_jets = time + (end_x_ - b.position.x() + drop) / vx;
      p.late += at_jets - seen_at - case_.camera.distance / v;
    }
    p.spin = rests ? Vec3::Zero() : b.angular_velocity;
    p.slip = r.seen ? p.slip : 0.0;
    if (r.which < wanted) --coming;
  };

  for (auto look = static_cast<std::int64_t>(std::floor(enters(order[0]) / kLook)); coming > 0; ++look) {
    const double time = static_cast<double>(look) * kLook;
    for (; next < order.size() && enters(order[next]) <= time; ++next) {
      const FeedParticle& p = tray[order[next]];
      Body b = body_of(p, (*classes_)[static_cast<std::size_t>(p.kind)].spec());
      const Vec3 down = b.orientation.conjugate() * Vec3(0, 0, -1);
      b.position = Vec3(u * time - p.x, p.y, case_.feed.lip_height + down.dot(b.shape.support(down)));
      b.velocity = Vec3(u, 0, 0);
      s.dem.add(std::move(b));
      s.riders.push_back({.which = order[next]});
    }
    if (s.riders.empty()) continue;
    s.dem.advance(kLook);
    const double now = time + kLook;
    const auto bodies = s.dem.bodies();
    for (std::size_t n = 0; n < s.riders.size(); ++n) {
      const Body& b = bodies[n];
      Scene::Rider& r = s.riders[n];
      FeedParticle& p = out[r.which];
      const double slips =
          (b.velocity - Vec3(v, 0, 0)).norm() + b.angular_velocity.norm() * b.shape.bounding_radius();
      const bool fell = b.position.z() < case_.feed.lip_height;  // not on a tray that is as fast as the belt
      r.still = fell && slips < kStill ? r.still + kLook : 0.0;
      if (!r.seen && b.position.x() >= camera_x_) {
        r.seen = true;
        const double since = (b.position.x() - camera_x_) / b.velocity.x();
        r.seen_at = now - since;
        r.seen_turn = b.orientation;
        p.y = b.position.y() - since * b.velocity.y();
        p.slip = v - b.velocity.x();
      }
      if (now > tray[r.which].x / u + longest) come_never(p);
    }
    // Who rests is taken out, and rides on, as soon as nobody moves near it.
    const auto is_disturbed = [&](std::size_t n) {
      for (std::size_t m = 0; m < s.riders.size(); ++m) {
        if (s.riders[m].still >= kStillFor) continue;
        const double near = bodies[n].shape.bounding_radius() + bodies[m].shape.bounding_radius() + largest_;
        if ((bodies[n].position - bodies[m].position).squaredNorm() < near * near) return true;
      }
      return false;
    };
    std::vector<std::size_t> leaving;
    for (std::size_t n = 0; n < s.riders.size(); ++n) {
      const bool ends = bodies[n].position.x() >= end_x_;
      if (ends) leave(n, now, bodies[n].velocity.x());
      else if (s.riders[n].still >= kStillFor && !is_disturbed(n)) leave(n, now, v);
      else continue;
      leaving.push_back(n);
    }
    for (auto n = leaving.rbegin(); n != leaving.rend(); ++n) {
      s.dem.remove(static_cast<int>(*n));
      s.riders.erase(s.riders.begin() + static_cast<std::ptrdiff_t>(*n));
    }
  }
  return out;
}

}  // namespace ejecta
