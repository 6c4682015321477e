#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/units.hpp"
#include "case/copies.hpp"
#include "case/extent.hpp"
#include "case/load.hpp"
#include "case/words.hpp"
#include "dem/body.hpp"
#include "flow/model/flow_model.hpp"
#include "jet/source.hpp"
#include "shape/stl.hpp"
#include "simulation/assumptions.hpp"
#include "simulation/body_checks.hpp"
#include "simulation/forecast.hpp"
#include "simulation/prospect.hpp"
#include "simulation/scene.hpp"
#include "simulation/sorter_run.hpp"

namespace ejecta {
namespace {

std::string size_words(double bytes) {
  if (bytes < 1e6) return fmt::format("{:.0f} kB", bytes / 1e3);
  if (bytes < 1e9) return fmt::format("{:.0f} MB", bytes / 1e6);
  return fmt::format("{:.1f} GB", bytes / 1e9);
}

std::string duration_words(double seconds) {
  if (seconds < 1.0) return "under a second";
  if (seconds < 120.0) return fmt::format("about {:.0f} s", seconds);
  if (seconds < 7200.0) return fmt::format("about {:.0f} min", seconds / 60.0);
  return fmt::format("about {:.1f} h", seconds / 3600.0);
}

/// An estimate should not look exact.
double two_digits(double v) {
  const double unit = std::pow(10.0, std::floor(std::log10(std::max(v, 1.0))) - 1.0);
  return std::round(v / unit) * unit;
}

std::string time_words(double seconds) {
  if (seconds == 0.0) return "0 ms";
  if (seconds < 1e-3) return fmt::format("{:.2g} us", 1e6 * seconds);
  return seconds < 1.0 ? fmt::format("{:.3g} ms", 1e3 * seconds) : fmt::format("{:.3g} s", seconds);
}

std::string length_words(double metres) { return fmt::format("{:.3g} mm", 1e3 * metres); }

std::string flow_part(const Case& c, const Company& company, std::span<const Body> grains, double bandwidth) {
  const Forecast f = forecast(c, company);
  std::string text = fmt::format("  flow         {}, {}\n", word(c.flow.solver), word(c.flow.turbulence));
  text += fmt::format("  cells        {} ({} to {} across, {:.3g} to {:.3g} mm3)\n", f.cells,
                      length_words(f.smallest_cell), length_words(f.largest_cell), 1e9 * f.smallest_volume,
                      1e9 * f.largest_volume);
  if (f.knows_step) {
    text += fmt::format("  steps        about {:.0f} with the fluid, {} and longer ({}), up to {}\n",
                        two_digits(static_cast<double>(f.steps)), time_words(f.time_step),
                        f.by_viscosity ? "explicit viscous terms"
                                       : fmt::format("{:.3g} m/s at Courant {}", f.fastest, c.run.courant),
                        time_words(f.air_until));
    text += fmt::format("  time         {} on this machine, longer if the fluid gets faster{}\n",
                        duration_words(expected_seconds(c, f, bandwidth, grains)),
                        grains.empty() ? "" : "; contacts of grains are not counted");
  } else {
    text += "  steps        unknown: no velocity is given, the flow makes its own\n";
  }
  text += fmt::format("  memory       about {}\n  disk         about {}\n", size_words(f.memory),
                      size_words(f.disk));
  return text;
}

/// What a surface from a file touches as.
std::string parts_words(const Shape& shape) {
  if (!shape.balls().empty()) return fmt::format(", as {} spheres", shape.balls().size());
  if (shape.polytopes().size() == 1) return ", convex";
  return fmt::format(", as {} convex parts, volume {:+.3f} %", shape.polytopes().size(),
                     100 * (shape.parts_volume() / shape.mass_properties().volume - 1));
}

/// Edges of the box in body axes that just holds it, its volume and mass.
std::string size_words(const Body& body) {
  const Vec3 size = body_size(body);
  const bool metres = size.maxCoeff() >= 1.0;
  const double unit = metres ? 1.0 : 1e3, volume = body.shape.mass_properties().volume;
  std::string text = fmt::format("{:.3g} x {:.3g} x {:.3g} {}, ", unit * size.x(), unit * size.y(),
                                 unit * size.z(), metres ? "m" : "mm");
  text += volume < 1e-9 ? fmt::format("{:.3g} mm3", 1e9 * volume)
          : metres      ? fmt::format("{:.3g} m3", volume)
                        : fmt::format("{:.3g} cm3", 1e6 * volume);
  return text + (body.mass < 1.0 ? fmt::format(", {:.3g} g", 1e3 * body.mass)
                                 : fmt::format(", {:.4g} kg", body.mass));
}

/// Where a prescribed body goes, and how fast.
std::string course_words(const Case& c, const Body& body) {
  constexpr int looks = 2000;
  const double dt = c.run.end_time / looks;
  Vec3 at = body.position, low = at, high = at;
  for (int n = 0; n < looks; ++n) {
    if (n * dt < body.release_at) continue;
    at += body.course->way(n * dt, dt);
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
  }
  std::string text = "\n               goes its way in";
  for (int d = 0; d < 3; ++d) {
    text += fmt::format("{} {} {:.4g}", d == 0 ? "" : ",", "xyz"[d], 1e3 * low[d]);
    if (high[d] - low[d] > 1e-9) text += fmt::format(" to {:.4g}", 1e3 * high[d]);
  }
  const Course::Pace pace = body.course->pace(c.run.end_time);
  text += fmt::format(" mm, up to {:.3g} m/s", pace.speed.norm());
  if (pace.spin > 0.0) text += fmt::format(" and {:.3g} rad/s", pace.spin);
  return text + fmt::format(", to ({:.4g}, {:.4g}, {:.4g}) mm", 1e3 * at.x(), 1e3 * at.y(), 1e3 * at.z());
}

/// `grid`: null without a flow.
std::string body_part(const Case& c, const Company& company, const Grid* grid, std::size_t n,
                      const Splitter* plate) {
  const BodySpec& b = c.bodies[n];
  const Body& body = company.bodies[n];
  std::string text = fmt::format("  body         \"{}\", {}, {}: {}", b.name, word(b.shape), word(b.motion),
                                 size_words(body));
  const bool jet = grid && has_jet(c);
  if (grid) {
    const Vec3 at = b.on_belt ? place_of_interest(c, b) : body.position;
    text += fmt::format(", {}", resolution_words(resolution_of(*grid, body, at), body));
  }
  if (!b.file.empty() || !b.files.empty()) text += parts_words(body.shape);
  if (body.course) text += course_words(c, body);
  if (body.motion != Motion::fixed && (b.on_belt || plate || jet)) {
    const std::string prospects = prospect_words(prospect_of(c, company, n, plate), jet);
    if (!prospects.empty()) text += "\n               undisturbed: " + prospects;
  }
  return text + "\n";
}

/// How many grains of each name the scene holds, and what they make up.
std::string grains_part(const Case& c, const Scene& scene) {
  std::string text;
  const auto grains = scene.particles.bodies().subspan(scene.bodies);
  for (const GrainsSpec& g : c.grains) {
    std::size_t count = 0;
    double mass = 0.0, volume = 0.0, least = 1e300, most = 0.0;
    for (const Body& b : grains) {
      if (b.name != g.name) continue;
      ++count;
      mass += b.mass;
      volume += b.shape.mass_properties().volume;
      least = std::min(least, 2 * b.shape.bounding_radius());
      most = std::max(most, 2 * b.shape.bounding_radius());
    }
    text += fmt::format("  grains       \"{}\": {} of {:.4g}{} mm, {:.4g} g{}", g.name, count, 1e3 * least,
                        most > least ? fmt::format(" to {:.4g}", 1e3 * most) : "", 1e3 * mass,
                        g.held ? ", held" : "");
    if (g.region && g.over == 0.0)
      text += fmt::format(", {:.3g} of their region", volume / ((*g.region)[1] - (*g.region)[0]).prod());
    text += "\n";
  }
  return text;
}

/// Surfaces from files alone: what stands in the case one sees there.
std::string wall_part(const Case& c, const WallSpec& w) {
  if (w.kind != WallKind::mesh) return "";
  const TriangleMesh mesh = read_stl(beside_case(c, w.file), w.scale);
  const Vec3 size = 1e3 * extent_of(mesh);
  return fmt::format("  wall         \"{}\", {} triangles: {:.4g} x {:.4g} x {:.4g} mm\n", w.name,
                     mesh.triangles.size(), size.x(), size.y(), size.z());
}

std::string valve_part(const Case& c) {
  if (c.flow.solver == FlowSolver::none || !has_jet(c)) return "";
  const ValveProspect v = prospect_of_valve(c);
  std::string text =
      fmt::format("  valve        {:.4g} kPa gauge, opens at {}, ",
                  1e-3 * (c.valve.supply_pressure - c.environment.pressure), time_words(v.open.from));
  if (v.widest > 0.999)
    text +=
        fmt::format("is fully open from {} to {}", time_words(v.widest_at.from), time_words(v.widest_at.to));
  else text += fmt::format("opens to {:.0f} % at {}", 100 * v.widest, time_words(v.widest_at.from));
  text += fmt::format(", shut at {}", time_words(v.open.to));
  if (!c.valve.more_pulses.empty())
    text += fmt::format(", and {} more pulse{}", c.valve.more_pulses.size(),
                        c.valve.more_pulses.size() == 1 ? "" : "s");
  return text + "\n";
}

std::string plate_part(const Case& c, const Splitter* plate) {
  if (!plate) return "";
  const Vec3 from_nozzle = plate->edge() - c.jet.nozzle;
  const std::string at = fmt::format("  plate        edge at x, z = {:.4g}, {:.4g} mm from the nozzle, ",
                                     1e3 * from_nozzle.x(), 1e3 * from_nozzle.z());
  if (c.splitter.edge) return at + "fixed to the machine (splitter.edge)\n";
  return at +
         fmt::format("{:.4g} mm above the undisturbed path there, with which it moves (splitter.height)\n",
                     1e3 * c.splitter.height);
}

/// The belt of a sorter and what comes on it; its box carries the jet of a valve and is computed by none.
std::string sorter_part(const Case& c) {
  const SorterForecast f = sorter_forecast(c);
  std::string text = fmt::format(
      "  sorter       about {:.0f} particles on {:.4g} m of belt, {:.3g} s, {:.3g} t/h; they cover {:.3g} % "
      "of it\n",
      f.particles, f.belt, f.time, 3.6 * f.mass / f.time, 100.0 * f.cover);
  for (const ParticleClassSpec& k : c.classes)
    text += fmt::format("  class        \"{}\", {:.3g} % of the mass, {}\n", k.name, 100.0 * k.share,
                        k.eject ? "to be ejected" : "to be kept");
  text += fmt::format("  manifold     {} valves every {:.4g} mm{}\n", c.manifold.valves, 1e3 * valve_pitch(c),
                      c.manifold.vessel > 0.0
                          ? fmt::format(", from a vessel of {:.4g} L", 1e3 * c.manifold.vessel)
                          : std::string());
  return text;
}

}  // namespace

std::string check_report(const Case& c, const Scene& scene, const std::vector<Problem>& warnings,
                         double bandwidth) {
  std::string text =
      fmt::format("{}{}\n", c.path, c.run.title.empty() ? "" : fmt::format(": {}", c.run.title));
  const Company company = company_of(scene);
  std::optional<Grid> grid;
  if (c.sorter.enabled) {
    text += sorter_part(c);
  } else if (c.flow.solver != FlowSolver::none) {
    grid.emplace(make_grid(c));
    text += flow_part(c, company, scene.particles.bodies().subspan(scene.bodies), bandwidth);
  } else {
    text += fmt::format("  flow         none, up to {}\n", format_quantity(c.run.end_time, Dimension::time));
  }
  const Case all = with_first_copies(c);
  const Splitter* plate = scene.splitter ? &*scene.splitter : nullptr;
  for (std::size_t n = 0; n < all.bodies.size(); ++n)
    text += body_part(all, company, grid ? &*grid : nullptr, n, plate);
  text += grains_part(c, scene);
  for (const WallSpec& w : c.walls) text += wall_part(c, w);
  if (!c.sorter.enabled) text += valve_part(c);  // its controller says when valves open
  text += plate_part(c, plate);
  const std::vector<output::Assumption> assumed = assumptions(c);
  if (!assumed.empty()) text += "  assumptions, since the case does not say:\n";
  for (const output::Assumption& a : assumed)
    text += fmt::format("    {} = {}  ({}{}{})\n", a.key, a.value, a.what, a.reason.empty() ? "" : ": ",
                        a.reason);
  for (const Problem& p : warnings) text += render(p);
  return text;
}

}  // namespace ejecta
