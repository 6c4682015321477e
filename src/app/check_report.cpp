#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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
std::string parts_words(const Case& c, const BodySpec& b) {
  const Shape shape = make_shape(b, folder_of(c));
  if (!shape.balls().empty()) return fmt::format(", as {} spheres", shape.balls().size());
  return fmt::format(", as {} convex parts, volume {:+.3f} %", shape.polytopes().size(),
                     100 * (shape.parts_volume() / shape.mass_properties().volume - 1));
}

std::string body_part(const Case& c, const BodySpec& b) {
  std::string text = fmt::format("  body         \"{}\", {}, {}", b.name, word(b.shape), word(b.motion));
  if (c.flow.solver != FlowSolver::none && smallest_feature(b) > 0.0)
    text += fmt::format(": {:.1f} cells across its smallest feature ({})", cells_across(c, b),
                        length_words(smallest_feature(b)));
  if (!b.file.empty() || !b.files.empty()) text += parts_words(c, b);
  return text + "\n";
}

}  // namespace

std::string check_report(const Case& c, const std::vector<Problem>& warnings, double bandwidth) {
  std::string text =
      fmt::format("{}{}\n", c.path, c.run.title.empty() ? "" : fmt::format(": {}", c.run.title));
  if (c.flow.solver == FlowSolver::none)
    text += fmt::format("  flow         none, up to {}\n", format_quantity(c.run.end_time, Dimension::time));
  else text += flow_part(c, bandwidth);
  for (const BodySpec& b : c.bodies) text += body_part(c, b);
  const std::vector<std::string> assumed = assumptions(c);
  if (!assumed.empty()) text += "  assumptions in force:\n";
  for (const std::string& a : assumed) text += fmt::format("    {}\n", a);
  for (const Problem& p : warnings) text += render(p);
  return text;
}

}  // namespace ejecta
