#include "simulation/prospect.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "case/copies.hpp"
#include "case/extent.hpp"
#include "case/load.hpp"
#include "case/schema.hpp"
#include "jet/source.hpp"
#include "jet/valve.hpp"

namespace ejecta {
namespace {

constexpr double kLook = 1e-4;  // s, between two looks at a body
constexpr int kFewestLooks = 1000, kMostLooks = 100000;

/// Half-widths of the jet: at twice the radius of half its speed it blows with a seventh of that on its axis.
constexpr double kJetWidth = 2.0;

std::string ms(double seconds) { return fmt::format("{:.3g} ms", 1e3 * seconds); }
std::string mm(double metres) { return fmt::format("{:.3g} mm", 1e3 * metres); }

int looks_at(const Case& c) {
  return std::clamp(static_cast<int>(std::min(c.run.end_time / kLook, 1e9)), kFewestLooks, kMostLooks);
}

/// Its centre at times 0, dt, ..., end of the run.
std::vector<Vec3> way_of(const Case& c, const Body& body, const FlightState& start, double dt, int looks) {
  std::vector<Vec3> way;
  Vec3 driven = start.position;
  for (int n = 0; n <= looks; ++n) {
    const double t = n * dt;
    if (body.motion == Motion::fixed) way.push_back(start.position);
    else if (body.course) way.push_back(driven);
    else way.push_back(free_flight(start, c.environment.gravity, std::max(0.0, t - body.release_at)));
    if (body.course && t >= body.release_at) driven += body.course->way(t, dt);
  }
  return way;
}

void widen(std::optional<Span>& span, double t) {
  if (!span) span = Span{t, t};
  span->to = t;
}

/// The face of the box through which a body leaves it first, and when, s; face -1: none.
struct Leave {
  int face = -1;
  double time = 0.0;
  Vec3 at{0, 0, 0};
};
Leave leave_of(const Box& box, std::span<const Vec3> way, double dt) {
  for (std::size_t k = 1; k < way.size(); ++k)
    for (int face = 0; face < 6; ++face) {
      const int d = face / 2;
      const auto out = [&](const Vec3& x) { return face % 2 ? x[d] > box.high[d] : x[d] < box.low[d]; };
      if (box.contains(way[k - 1]) && out(way[k])) return {face, static_cast<double>(k) * dt, way[k]};
    }
  return {};
}

/// From the surface of the body at x to where a jet blows, m; below 0: it is in it.
double beside_jet(const Case& c, const Body& body, const Vec3& x) {
  const Vec3 along = c.jet.direction.normalized();
  std::vector<Vec3> nozzles = c.jet.more_nozzles;
  nozzles.push_back(c.jet.nozzle);
  double least = 1e300;
  for (const Vec3& nozzle : nozzles) {
    const double height = along.dot(x - nozzle);
    const Vec3 off = x - nozzle - height * along;
    const double radius = std::max(kJetWidth * c.jet.spreading * height, 0.5 * c.valve.orifice_diameter);
    // Its own reach towards the axis.
    const Vec3 towards =
        body.orientation.conjugate() * (off.norm() > 0.0 ? Vec3(-off.normalized()) : Vec3(1, 0, 0));
    const double reach = towards.dot(body.shape.support(towards));
    const Vec3 up = body.orientation.conjugate() * along;
    const bool behind = height + up.dot(body.shape.support(up)) < 0.0;
    least = std::min(least, behind ? body.shape.bounding_radius() - height : off.norm() - radius - reach);
  }
  return least;
}

/// Whether air flows in at a place on a face of the box; of a face with the jet, only where that blows.
bool lets_air_in(const Case& c, int face, const Body& body, const Vec3& x) {
  const BoundarySpec& spec = c.boundary[static_cast<std::size_t>(face)];
  const auto blows = [&](BoundaryType t) {
    return t == BoundaryType::velocity || t == BoundaryType::total_pressure ||
           (t == BoundaryType::jet && beside_jet(c, body, x) <= 0.0);
  };
  return blows(spec.type) || std::any_of(spec.patches.begin(), spec.patches.end(), [&](const PatchSpec& p) {
           return blows(p.type) && (p.centre - x).norm() < p.radius + body.shape.bounding_radius();
         });
}

}  // namespace

Company company_of(const Case& c) {
  Company company;
  const Materials materials(c);
  for (const BodySpec& spec : c.bodies) company.bodies.push_back(make_body(spec, materials, folder_of(c)));
  company.starts = flight_starts(c, company.bodies);
  return company;
}

Company company_of(const Scene& scene) {
  const auto bodies = scene.particles.bodies().first(scene.bodies);
  return {{bodies.begin(), bodies.end()}, scene.starts};
}

Prospect prospect_of(const Case& c, const Company& company, std::size_t n, const Splitter* plate) {
  const Body& body = company.bodies[n];
  const FlightState& start = company.starts[n];
  const int looks = looks_at(c);
  const double dt = c.run.end_time / looks;
  const std::vector<Vec3> way = way_of(c, body, start, dt, looks);
  const bool flows = c.flow.solver != FlowSolver::none;
  const bool jet = flows && has_jet(c);
  const std::optional<Box> box = flows ? grid_box(c) : std::nullopt;
  const double radius = body.shape.bounding_radius();
  Prospect p;
  p.beside = 1e300;
  for (int k = 0; k <= looks; ++k) {
    const Vec3& x = way[static_cast<std::size_t>(k)];
    if (box && (x.array() + radius >= box->low.array()).all() &&
        (x.array() - radius <= box->high.array()).all())
      widen(p.in_box, k * dt);
    if (!jet) continue;
    const double beside = beside_jet(c, body, x);
    p.beside = std::min(p.beside, beside);
    if (beside <= 0.0) widen(p.over_jet, k * dt);
  }
  if (!plate || !plate->judges(n)) return p;
  const double edge = plate->edge().x();
  if (!body.course) {
    if (start.velocity.x() > 0.0 && start.position.x() < edge) {
      const double flight = (edge - start.position.x()) / start.velocity.x();
      p.at_plate = body.release_at + flight;
      p.above_edge = free_flight(start, c.environment.gravity, flight).z() - plate->edge().z();
    }
    return p;
  }
  for (int k = 1; k <= looks && !p.at_plate; ++k)
    if (const Vec3& x = way[static_cast<std::size_t>(k)];
        x.x() >= edge && way[static_cast<std::size_t>(k - 1)].x() < edge) {
      p.at_plate = k * dt;
      p.above_edge = x.z() - plate->edge().z();
    }
  return p;
}

ValveProspect prospect_of_valve(const Case& c) {
  const Valve valve(c.valve, folder_of(c));
  ValveProspect v;
  // Of the first pulse: what follows does the same.
  const double from = valve.events().front();
  const double until = c.valve.more_pulses.empty() || c.valve.shape != ValveShape::trace ? valve.closed_from()
                                                                                         : valve.events()[1];
  const double shut = c.valve.shape == ValveShape::trace
                          ? until
                          : std::min(until, from + c.valve.duration + c.valve.fall_time);
  v.open = {from, shut};
  constexpr int looks = 4000;
  constexpr double kFull = 1e-6;
  for (int n = 0; n <= looks; ++n)
    v.widest = std::max(v.widest, valve.opening(from + (shut - from) * n / looks));
  std::optional<Span> at;
  for (int n = 0; n <= looks; ++n) {
    const double t = from + (shut - from) * n / looks;
    if (valve.opening(t) >= v.widest - kFull) widen(at, t);
  }
  if (at) v.widest_at = *at;
  return v;
}

std::vector<Problem> check_prospects(const Case& c, const Company& company, const Splitter* plate) {
  std::vector<Problem> found;
  const auto warn = [&](const std::string& key, const std::string& what, const std::string& expected,
                        const std::string& example = "") {
    found.push_back(
        {.key = key, .what = what, .expected = expected, .example = example, .severity = Severity::warning});
  };
  const bool jet = c.flow.solver != FlowSolver::none && has_jet(c) && c.jet.kind != JetKind::computed;
  const bool has_valve = c.flow.solver != FlowSolver::none && has_jet(c);
  std::optional<Valve> valve;
  if (has_valve) valve.emplace(c.valve, folder_of(c));
  if (has_valve) {
    const ValveProspect v = prospect_of_valve(c);
    if (v.widest < 0.999 && c.valve.shape != ValveShape::trace && c.valve.shape != ValveShape::exponential)
      warn(c.given.contains("valve.rise_time") ? "valve.rise_time" : "valve.duration",
           fmt::format("the valve never opens fully: it takes {} to open{}, but the pulse lasts {}; it opens "
                       "to {:.0f} %",
                       ms(c.valve.rise_time), c.given.contains("valve.rise_time") ? "" : " (by default)",
                       ms(c.valve.duration), 100 * v.widest),
           "a rise_time as measured, or a pulse longer than it",
           fmt::format("rise_time = \"{}\"", ms(0.2 * c.valve.duration)));
  }
  if (const auto box = c.flow.solver != FlowSolver::none ? grid_box(c) : std::nullopt;
      box && plate && c.splitter.solid) {
    const Vec3 low = plate->edge() - Vec3(0.0, 0.0, c.splitter.thickness),
               high = plate->edge() + Vec3(c.splitter.length, 0.0, 0.0);
    if (low.x() < box->high.x() && high.x() > box->low.x() && low.z() < box->high.z() &&
        high.z() > box->low.z())
      warn(c.splitter.edge ? "splitter.edge" : "splitter.distance",
           "the plate reaches into the computed box, but no air sees it: only bodies do",
           fmt::format("an edge behind the box, which ends at x = {}", mm(box->high.x())));
  }
  double last_arrival = 0.0;
  bool flies = false, arrives = false;
  for (std::size_t n = 0; n < company.bodies.size(); ++n) {
    const BodySpec& spec = c.bodies[n];
    if (company.bodies[n].motion == Motion::fixed || spec.enters_at) continue;
    const Prospect p = prospect_of(c, company, n, plate);
    const std::string key =
        spec.on_belt ? fmt::format("body.{}.on_belt", n) : fmt::format("body.{}.position", n);
    if (plate && plate->judges(n) && p.at_plate) {
      flies = true;
      last_arrival = std::max(last_arrival, *p.at_plate);
      arrives = arrives || *p.at_plate <= c.run.end_time;
    }
    if (c.flow.solver != FlowSolver::none && !p.in_box && c.run.end_time > 0.0) {
      warn(key,
           fmt::format("no air ever meets \"{}\": undisturbed it never comes into the computed box",
                       spec.name),
           "a path through the [grid]");
      continue;
    }
    if (const auto box = c.flow.solver != FlowSolver::none ? grid_box(c) : std::nullopt) {
      const int looks = looks_at(c);
      const double dt = c.run.end_time / looks;
      const Body& body = company.bodies[n];
      const Leave leave = leave_of(*box, way_of(c, body, company.starts[n], dt, looks), dt);
      if (leave.face >= 0 && lets_air_in(c, leave.face, body, leave.at))
        warn(key,
             fmt::format(
                 "undisturbed \"{}\" leaves the box at {} through {}, where air flows in: what flows in "
                 "there knows nothing of it",
                 spec.name, ms(leave.time), face_names[static_cast<std::size_t>(leave.face)]),
             "a path that leaves through another face, or an end before that");
    }
    if (!jet || !(spec.on_belt || p.at_plate)) continue;  // one that goes elsewhere need not meet it
    if (!p.over_jet) {
      warn(spec.on_belt && c.launch.offset_across != 0.0 && spec.across == 0.0 ? "launch.offset_across" : key,
           fmt::format("the jet misses \"{}\": undisturbed it passes {} beside where the jet blows",
                       spec.name, mm(p.beside)),
           "a path through the jet");
      continue;
    }
    bool blown = false;
    constexpr int looks = 1000;
    for (int k = 0; k <= looks && !blown; ++k)
      blown = valve->opening(p.over_jet->from + (p.over_jet->to - p.over_jet->from) * k / looks) > 0.0;
    if (blown) continue;
    const ValveProspect v = prospect_of_valve(c);
    const double middle = 0.5 * (p.over_jet->from + p.over_jet->to);
    warn(
        "valve.opens_at",
        fmt::format("the pulse misses \"{}\" altogether: it is over the jet from {} to {}, the jet blows "
                    "from {} to {}",
                    spec.name, ms(p.over_jet->from), ms(p.over_jet->to), ms(v.open.from), ms(v.open.to)),
        "a pulse while the body is over the jet",
        fmt::format("opens_at = \"{}\"", ms(std::max(0.0, middle - 0.5 * c.valve.duration - c.valve.delay))));
  }
  if (plate && flies && last_arrival > c.run.end_time)
    warn("run.end_time",
         fmt::format("the run ends at {}, before {} the plate: undisturbed, the last passes its edge at {}",
                     ms(c.run.end_time), arrives ? "all bodies have come to" : "any body comes to",
                     ms(last_arrival)),
         "an end after that: until = \"verdict\" stops the run as soon as it can",
         fmt::format("end_time = \"{:.0f} ms\"", std::ceil(1.5e3 * last_arrival)));
  return found;
}

std::string prospect_words(const Prospect& p, bool jet) {
  std::string text;
  if (jet && p.over_jet)
    text += fmt::format("over the jet from {} to {}", ms(p.over_jet->from), ms(p.over_jet->to));
  if (jet && !p.over_jet && p.beside < 1e300)
    text += fmt::format("passes the jet {} beside it", mm(p.beside));
  if (p.at_plate)
    text += fmt::format("{}past the plate's edge at {}, {} {} it", text.empty() ? "" : ", ", ms(*p.at_plate),
                        mm(std::abs(p.above_edge)), p.above_edge < 0.0 ? "below" : "above");
  return text;
}

}  // namespace ejecta
