#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/body_checks.hpp"
#include "app/flow_model.hpp"
#include "app/forecast.hpp"
#include "base/units.hpp"
#include "case/extent.hpp"
#include "case/load.hpp"
#include "case/words.hpp"
#include "dem/body.hpp"

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
  if (seconds < 1e-3) return fmt::format("{:.2g} us", 1e6 * seconds);
  return seconds < 1.0 ? fmt::format("{:.3g} ms", 1e3 * seconds) : fmt::format("{:.3g} s", seconds);
}

std::string length_words(double metres) { return fmt::format("{:.3g} mm", 1e3 * metres); }

std::string flow_part(const Case& c, double bandwidth) {
  const Forecast f = forecast(c);
  std::string text = fmt::format("  flow         {}, {}\n", word(c.flow.solver), word(c.flow.turbulence));
  text += fmt::format("  cells        {} ({} to {} across, {:.3g} to {:.3g} mm3)\n", f.cells,
                      length_words(f.smallest_cell), length_words(f.largest_cell), 1e9 * f.smallest_volume,
                      1e9 * f.largest_volume);
  if (f.fastest > 0.0 || c.run.time_step) {
    text += fmt::format(
        "  steps        about {:.0f} with the fluid, {} and longer ({:.3g} m/s at Courant {}), up to {}\n",
        two_digits(static_cast<double>(f.steps)), time_words(f.time_step), f.fastest, c.run.courant,
        time_words(f.air_until));
    text += fmt::format("  time         {} on this machine, longer if the fluid gets faster\n",
                        duration_words(expected_seconds(c, f, bandwidth)));
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
  return fmt::format(", as {} convex parts, volume {:+.3f} %", shape.polytopes().size(),
                     100 * (shape.parts_volume() / shape.mass_properties().volume - 1));
}

/// Edges of the box in body axes that just holds it, and its mass.
std::string size_words(const Body& body) {
  std::string text;
  for (int d = 0; d < 3; ++d) {
    const Vec3 along = Vec3::Unit(d);
    const double size = along.dot(body.shape.support(along)) - along.dot(body.shape.support(-along));
    text += fmt::format("{}{:.3g}", d == 0 ? "" : " x ", 1e3 * size);
  }
  return fmt::format("{} mm, {:.3g} g", text, 1e3 * body.mass);
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

std::string body_part(const Case& c, const BodySpec& b, const Materials& materials) {
  const Body body = make_body(b, materials, folder_of(c));
  std::string text = fmt::format("  body         \"{}\", {}, {}: {}", b.name, word(b.shape), word(b.motion),
                                 size_words(body));
  if (c.flow.solver != FlowSolver::none) {
    const Vec3 at = b.on_belt ? place_of_interest(c, b) : body.position;
    text += fmt::format(", {}", resolution_words(resolution_of(make_grid(c), body, at), body));
  }
  if (!b.file.empty() || !b.files.empty()) text += parts_words(body.shape);
  if (body.course) text += course_words(c, body);
  return text + "\n";
}

}  // namespace

std::string check_report(const Case& c, const std::vector<Problem>& warnings, double bandwidth) {
  std::string text =
      fmt::format("{}{}\n", c.path, c.run.title.empty() ? "" : fmt::format(": {}", c.run.title));
  if (c.flow.solver == FlowSolver::none)
    text += fmt::format("  flow         none, up to {}\n", format_quantity(c.run.end_time, Dimension::time));
  else text += flow_part(c, bandwidth);
  const Materials materials(c);
  for (const BodySpec& b : c.bodies) text += body_part(c, b, materials);
  const std::vector<std::string> assumed = assumptions(c);
  if (!assumed.empty()) text += "  assumptions in force:\n";
  for (const std::string& a : assumed) text += fmt::format("    {}\n", a);
  for (const Problem& p : warnings) text += render(p);
  return text;
}

}  // namespace ejecta
