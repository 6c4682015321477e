#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "base/units.hpp"
#include "case/expression.hpp"
#include "case/findings.hpp"
#include "case/load.hpp"
#include "case/path_file.hpp"

/// How prescribed bodies move.
namespace ejecta {
namespace {

constexpr int kLooks = 1000;  // at a formula over the run
constexpr std::uintmax_t largest_file = 64 << 20;

constexpr const char* kFormulaExample = R"x(velocity = ["= 0.2 * cos(100 * t)", "0 m/s", "0 m/s"])x";

void check_formulas(const Case& c, const BodySpec& b, const std::string& key,
                    const std::optional<std::array<std::string, 3>>& formulas, Findings& found) {
  if (!formulas) return;
  if (b.motion != Motion::prescribed)
    return found.error(key, "only a prescribed body follows a formula",
                       "three quantities, or motion = \"prescribed\"", "motion = \"prescribed\"");
  for (const std::string& text : *formulas) {
    const Expression formula(text);
    if (formula.uses_space())
      return found.error(key, fmt::format("\"{}\" depends on the place, not on the time alone", text),
                         "formulas in t", kFormulaExample);
    for (int n = 0; n <= kLooks; ++n) {
      const double t = c.run.end_time * n / kLooks, value = formula(0, 0, 0, t);
      if (!std::isfinite(value))
        return found.error(
            key, fmt::format("\"{}\" gives {} at t = {}", text, value, format_quantity(t, Dimension::time)),
            "a number at all times of the run", kFormulaExample);
    }
  }
}

void check_path(const Case& c, const BodySpec& b, const std::string& key, Findings& found) {
  if (b.path.empty()) return;
  const std::string path_key = key + ".path";
  if (b.motion != Motion::prescribed)
    return found.error(path_key, "only a prescribed body follows a path", "motion = \"prescribed\"",
                       "motion = \"prescribed\"");
  if (!b.velocity.isZero() || !b.spin.isZero() || b.velocity_formula || b.spin_formula)
    return found.error(path_key, "the path gives the velocity already", "either path, or velocity and spin",
                       fmt::format("path = \"{}\"", b.path));
  if (b.release_at > 0.0 || b.enters_at || b.copies > 1)
    return found.error(path_key, "the path says where the body is at all times of the run",
                       "no release_at, enters_at or copies; equal places in the path where it rests",
                       fmt::format("path = \"{}\"", b.path));
  if (!require_file(c, path_key, b.path, "missing: the file", "path = \"path.csv\"", found)) return;
  std::error_code ignored;
  const std::string file = beside_case(c, b.path);
  // Devices and the like have no size: they could be read for ever.
  if (const auto size = std::filesystem::file_size(file, ignored); size == 0 || size > largest_file)
    return found.error(path_key,
                       fmt::format("\"{}\" is {}", file, size == 0 ? "empty" : "no path: it is too large"),
                       "a few lines of times and places", "path = \"path.csv\"");
  const std::size_t before = found.list.size();
  const PathTable table = read_path_file(file, found.list);
  for (std::size_t n = before; n < found.list.size(); ++n) found.list[n].key = path_key;
  if (found.list.size() > before) return;
  const double from = table.time.front(), to = table.time.back();
  if (from > 0.0 || to < c.run.end_time * (1 - 1e-12))
    found.error(
        path_key,
        fmt::format("the path is from {} to {}, the run from 0 to {}", format_quantity(from, Dimension::time),
                    format_quantity(to, Dimension::time), format_quantity(c.run.end_time, Dimension::time)),
        "a path for the whole run; where the body rests, the same place twice",
        from > 0.0 ? "time [ms], x [mm], y [mm], z [mm]: the first row at 0"
                   : fmt::format("[run] end_time = \"{}\"", format_quantity(to, Dimension::time)));
}

}  // namespace

void sense_motion(const Case& c, Findings& found) {
  for (std::size_t n = 0; n < c.bodies.size(); ++n) {
    const BodySpec& b = c.bodies[n];
    const std::string key = fmt::format("body.{}", n);
    check_formulas(c, b, key + ".velocity", b.velocity_formula, found);
    check_formulas(c, b, key + ".spin", b.spin_formula, found);
    check_path(c, b, key, found);
  }
}

}  // namespace ejecta
