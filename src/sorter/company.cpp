#include "sorter/company.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>

#include "base/joined_sets.hpp"
#include "base/thread_budget.hpp"
#include "dem/particles.hpp"
#include "sorter/particle_class.hpp"
#include "sorter/plan_view.hpp"

namespace ejecta {
namespace {

/// s, of a flight together: who has not come to the plate by then never does.
constexpr double kLongestFlight = 0.5;
/// Bodies that were pushed come near others, who are pushed in turn: a chain of so many is followed.
constexpr int kRounds = 4;
/// m: what comes as near, alone, is flown together.
constexpr double kNear = 5e-4;

/// A place on a belt that runs on under the flight: bodies that nothing pushes stay where they are on it.
struct Footprint {
  double x_low = 1e300, x_high = -1e300, y_low = 1e300, y_high = -1e300;
  void add(const Vec3& place, double belt, double radius) {
    x_low = std::min(x_low, place.x() - belt - radius);
    x_high = std::max(x_high, place.x() - belt + radius);
    y_low = std::min(y_low, place.y() - radius);
    y_high = std::max(y_high, place.y() + radius);
  }
  bool meets(const Footprint& o) const {
    return x_low < o.x_high && o.x_low < x_high && y_low < o.y_high && o.y_low < y_high;
  }
};

Footprint footprint(const Track& track, double belt_speed, double radius) {
  Footprint f;
  for (std::size_t n = 0; n < track.states.size(); ++n)
    f.add(track.states[n].position, belt_speed * (track.from + static_cast<double>(n) * Track::kStep),
          radius);
  f.add(track.end.position, belt_speed * track.until(), radius);
  f.add(track.at(track.passes).position, belt_speed * track.passes, radius);
  return f;
}

/// Visits each pair of footprints that meet, lower index first, by their lower ends along the belt.
template <class Visit>
void for_each_meeting(const std::vector<Footprint>& prints, const Visit& visit) {
  std::vector<std::size_t> order(prints.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return prints[a].x_low < prints[b].x_low; });
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t j = i + 1; j < order.size() && prints[order[j]].x_low < prints[order[i]].x_high; ++j)
      if (prints[order[i]].meets(prints[order[j]]))
        visit(std::min(order[i], order[j]), std::max(order[i], order[j]));
}

/// The least distance of two bodies that fly free for `time`, squared, m2.
double nearest_squared(const Vec3& apart, const Vec3& speed, double time) {
  const double v2 = speed.squaredNorm();
  const double when = v2 > 0.0 ? std::clamp(-apart.dot(speed) / v2, 0.0, time) : 0.0;
  return (apart + when * speed).squaredNorm();
}

/// m, from `point` to the straight line from an orifice to `at`; 1e300 where it lies before or behind it.
double off_the_ray(const Vec3& point, const Vec3& orifice, const Vec3& at, Vec3& nearest) {
  const Vec3 ray = at - orifice;
  const double share = (point - orifice).dot(ray) / ray.squaredNorm();
  if (!(share > 0.0) || share >= 1.0) return 1e300;
  nearest = orifice + share * ray;
  return (nearest - point).norm();
}

/// Bodies that air has to pass on its way to another one.
using InTheWay = std::vector<const Body*>;

bool stands_between(const InTheWay& bodies, const Vec3& orifice, const Vec3& at) {
  return std::any_of(bodies.begin(), bodies.end(), [&](const Body* b) {
    Vec3 nearest;
    return off_the_ray(b->position, orifice, at, nearest) < b->shape.bounding_radius() &&
           b->signed_distance(nearest) < 0.0;
  });
}

}  // namespace

Company::Company(const Case& c, const FastFlight& flight)
    : flight_(flight),
      classes_(c.classes),
      materials_(c),
      contact_(c.contact),
      belt_speed_(c.launch.belt_speed),
      meet_(c.sorter.encounters && c.feed.presentation != Presentation::independent) {
  if (!c.given.contains("contact.time_step_fraction")) contact_.time_step_fraction = kSorterStepFraction;
}

double Company::radius(const Flyer& f) const {
  return f.particle->scale * f.particle->prototype->shape.bounding_radius();
}

double Company::reach(const Flyer& f, const BodyState& s, const Vec3& direction) const {
  const Vec3 along = s.orientation.conjugate() * direction.normalized();
  return f.particle->scale * along.dot(f.particle->prototype->shape.support(along));
}

bool Company::lie_in_each_other(const Flyer& a, const Flyer& b) const {
  const auto outline = [&](const Flyer& f) {
    FeedParticle p = *f.particle;
    p.x = belt_speed_ * f.at;
    p.y = f.y;
    return outline_of(p);
  };
  return within_gap(outline(a), outline(b), 0.0);
}

bool Company::come_near(const Flyer& a, const FlightEnd& a_end, const Flyer& b,
                        const FlightEnd& b_end) const {
  double from = 1e300, until = -1e300;  // s, while one of them is pushed
  for (const FlightEnd* end : {&a_end, &b_end}) {
    if (!end->touched) continue;
    from = std::min(from, end->track.from);
    until = std::max(until, end->track.until());
  }
  const double passed = std::min(a_end.track.passes, b_end.track.passes), near = radius(a) + radius(b);
  for (double time = from; time < passed; time += Track::kStep) {
    const BodyState p = a_end.track.at(time), q = b_end.track.at(time);
    Vec3 apart = p.position - q.position;
    if (time < until) apart.z() = 0.0;  // above the other it may be in its lee
    else if (nearest_squared(apart, p.velocity - q.velocity, passed - time) >= near * near) return false;
    if (apart.squaredNorm() < near * near &&
        !(reach(a, p, -apart) + reach(b, q, apart) + kNear <= apart.norm()))
      return true;
  }
  return false;
}

/// Bodies that fly together, from before the first of them is pushed.
struct Company::Group {
  std::span<const std::size_t> members;
  std::span<const Flyer> flyers;
  const FastFlight& flight;
  Particles dem;
  std::vector<FastFlight::Begin> begins{};
  double from = 1e300, time = 0.0;  // s

  const Flyer& flyer(std::size_t n) const { return flyers[members[n]]; }
  std::size_t size() const { return members.size(); }
  BodyState state(std::size_t n) const {
    const Body& b = dem.bodies()[n];
    return {b.position, b.velocity, b.angular_velocity, b.orientation};
  }
  InTheWay in_the_way_of(std::size_t n) const {
    InTheWay list;
    const Body& self = dem.bodies()[n];
    for (std::size_t m = 0; m < size(); ++m) {
      const Body& other = dem.bodies()[m];
      const double near = self.shape.bounding_radius() + other.shape.bounding_radius();
      if (m != n && std::any_of(begins[n].blows.begin(), begins[n].blows.end(), [&](const Blow& blow) {
            Vec3 nearest;  // to a point behind its own centre: parts of it may be lower than the other's
            const Vec3 orifice(0, blow.y, 0), to = self.position - orifice;
            return off_the_ray(other.position, orifice, orifice + (1.0 + near / to.norm()) * to, nearest) <
                   near;
          }))
        list.push_back(&other);
    }
    return list;
  }
  /// The air's, on average over the next step.
  Load load(std::size_t n) const {
    BodyState middle = state(n);
    if (time >= begins[n].until || flight.is_past(flyer(n), middle)) return {};
    middle.drift(0.5 * Track::kStep);
    const InTheWay others = in_the_way_of(n);
    FastFlight::Hidden hidden;
    if (!others.empty())
      hidden = [&](const Blow& blow, const Vec3& at) {
        return stands_between(others, Vec3(0, blow.y, 0), at);
      };
    return flight.load(*flyer(n).particle, middle, begins[n], time + 0.5 * Track::kStep, hidden);
  }
  /// m/s, that it is faster upwards than if nothing had pushed it.
  double gain(std::size_t n) const {
    return dem.bodies()[n].velocity.z() - flight.free_state(flyer(n), time).velocity.z();
  }
  /// Nothing will push any of them before it comes to the plate.
  bool is_over() const {
    const auto bodies = dem.bodies();
    for (std::size_t a = 0; a < size(); ++a) {
      if (time < begins[a].until && !flight.is_past(flyer(a), state(a))) return false;
      const double left = flight.time_to_edge(state(a));
      for (std::size_t b = a + 1; b < size(); ++b) {
        const double near = bodies[a].shape.bounding_radius() + bodies[b].shape.bounding_radius(),
                     together = std::min(left, flight.time_to_edge(state(b)));
        if (together > 0.0 &&
            nearest_squared(bodies[a].position - bodies[b].position, bodies[a].velocity - bodies[b].velocity,
                            together) < near * near)
          return false;
      }
    }
    return true;
  }
};

std::vector<FlightEnd> Company::fly_together(std::span<const std::size_t> members,
                                             std::span<const Flyer> flyers) const {
  const ThreadBudget one(1);  // groups are many, and computed side by side
  Group g{.members = members,
          .flyers = flyers,
          .flight = flight_,
          .dem = Particles(flight_.gravity(), materials_, contact_)};
  for (const std::size_t n : members) {
    g.begins.push_back(flight_.begin(flyers[n]));
    if (!g.begins.back().blows.empty()) g.from = std::min(g.from, g.begins.back().from);
  }
  std::vector<FlightEnd> ends(g.size());
  for (std::size_t n = 0; n < g.size(); ++n) {
    const Flyer& f = g.flyer(n);
    const BodyState s = flight_.free_state(f, g.from);
    Body b = body_of(*f.particle, classes_[static_cast<std::size_t>(f.particle->kind)]);
    b.position = s.position;
    b.velocity = s.velocity;
    b.orientation = s.orientation;
    b.angular_velocity = s.spin;
    g.dem.add(std::move(b));
    ends[n].track = {.gravity = flight_.gravity(), .from = g.from};
  }
  g.dem.require_apart();
  std::vector<std::optional<FlightEnd>> passed(g.size());
  std::vector<Load> loads(g.size());
  for (g.time = g.from; !g.is_over() && g.time < g.from + kLongestFlight; g.time += Track::kStep) {
    for (std::size_t n = 0; n < g.size(); ++n) {
      loads[n] = g.load(n);
      ends[n].track.states.push_back(g.state(n));
    }
    g.dem.advance(Track::kStep, loads);
    for (std::size_t n = 0; n < g.size(); ++n) {
      const Vec3 &before = ends[n].track.states.back().position, &now = g.dem.bodies()[n].position;
      if (!passed[n] && before.x() < flight_.edge() && now.x() >= flight_.edge())
        passed[n] = flight_.pass(before, now, g.gain(n));
    }
  }
  for (std::size_t n = 0; n < g.size(); ++n) {
    ends[n].track.end = g.state(n);
    FlightEnd end = flight_.finish(std::move(ends[n].track), g.gain(n));
    if (passed[n]) {
      passed[n]->track = std::move(end.track);
      end = std::move(*passed[n]);
    }
    end.in_company = true;
    end.met = g.dem.peaks(static_cast<int>(n)).time > 0.0;
    end.touched = end.touched || end.met;
    ends[n] = std::move(end);
  }
  return ends;
}

std::vector<FlightEnd> Company::fly(std::span<const Flyer> flyers) const {
  std::vector<FlightEnd> ends;
  for (const Flyer& f : flyers) ends.push_back(flight_.fly(f));
  if (!meet_ || flyers.size() < 2) return ends;
  JoinedSets sets(flyers.size());
  std::vector<char> in_another(flyers.size());
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Footprint> prints;
    for (std::size_t n = 0; n < flyers.size(); ++n)
      prints.push_back(footprint(ends[n].track, belt_speed_, radius(flyers[n])));
    std::vector<std::array<std::size_t, 2>> near;
    for_each_meeting(prints, [&](std::size_t a, std::size_t b) {
      if (!(ends[a].touched || ends[b].touched) || sets.of(a) == sets.of(b)) return;
      if (!come_near(flyers[a], ends[a], flyers[b], ends[b])) return;
      if (lie_in_each_other(flyers[a], flyers[b])) in_another[a] = in_another[b] = 1;
      else near.push_back({a, b});
    });
    std::vector<char> grows(flyers.size());
    for (const auto& [a, b] : near)
      if (!in_another[a] && !in_another[b] && sets.join(a, b)) grows[a] = grows[b] = 1;
    std::map<std::size_t, std::vector<std::size_t>> groups;
    for (std::size_t n = 0; n < flyers.size(); ++n)
      if (grows[n]) groups[sets.of(n)];
    if (groups.empty()) break;
    for (std::size_t n = 0; n < flyers.size(); ++n)
      if (const auto group = groups.find(sets.of(n)); group != groups.end()) group->second.push_back(n);
    for (const auto& [name, members] : groups) {
      std::vector<FlightEnd> together;
      try {
        together = fly_together(members, flyers);
      } catch (const std::runtime_error&) {  // they lie in each other, if not as seen from above
        for (const std::size_t n : members) in_another[n] = 1;
        continue;
      }
      for (std::size_t n = 0; n < members.size(); ++n) ends[members[n]] = std::move(together[n]);
    }
  }
  for (std::size_t n = 0; n < flyers.size(); ++n) ends[n].in_another = in_another[n];
  return ends;
}

}  // namespace ejecta
