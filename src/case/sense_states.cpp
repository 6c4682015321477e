#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/units.hpp"
#include "case/expression.hpp"
#include "case/extent.hpp"
#include "case/findings.hpp"
#include "case/schema.hpp"

/// What states of faces and regions say: k and epsilon not below nothing, of a gas pressure, density and
/// temperature above it. They must make sense at the start and be numbers at any time of the run; later the
/// solver takes turbulence below nothing for still air.
namespace ejecta {
namespace {

// Along each axis: a formula that is wrong between so many places is not found, but the check stays quick.
constexpr std::size_t kLooksAtFace = 400, looks_at_region = 64, kLooksLater = 12;
constexpr int kLaterTimes = 16;

using Points = std::array<std::vector<double>, 3>;
using Inside = std::function<bool(const Vec3&)>;

/// What a formula or number may be at the start.
struct Allowed {
  bool zero = true;
  bool negative = false;
  std::string expected, example;
};

std::vector<double> thinned(const std::vector<double>& all, std::size_t most_looks) {
  const std::size_t step = (all.size() + most_looks - 1) / most_looks;
  std::vector<double> some;
  for (std::size_t n = 0; n < all.size(); n += std::max<std::size_t>(step, 1)) some.push_back(all[n]);
  return some;
}

/// Where and until when (s) a state holds; of a region: at the start alone.
struct Extent {
  Points at;
  Inside inside;
  double until = 0.0;
};

void check_formula(const std::string& key, const std::optional<std::string>& text, const Extent& extent,
                   const Allowed& allowed, Findings& found) {
  if (!text) return;
  const Expression formula(*text);
  const auto good = [&](double value) {
    return std::isfinite(value) && (allowed.negative || (allowed.zero ? value >= 0.0 : value > 0.0));
  };
  const auto words = [](double value) {
    return std::isnan(value) ? "no number" : fmt::format("{:.4g}", value);
  };
  if (formula.is_constant()) {
    if (const double value = formula(0, 0, 0, 0); !good(value))
      found.error(key, fmt::format("there is none of {}", words(value)), allowed.expected, allowed.example);
    return;
  }
  /// Whether all is well at that time; what is not is told.
  const auto look = [&](double t, const Points& at) {
    for (const double z : at[2])
      for (const double y : at[1])
        for (const double x : at[0]) {
          if (!extent.inside({x, y, z})) continue;
          const double value = formula(x, y, z, t);
          if (good(value) || (t > 0.0 && allowed.zero && std::isfinite(value))) continue;
          found.error(key,
                      fmt::format("the formula gives {} at x, y, z = {:.4g}, {:.4g}, {:.4g} mm {}",
                                  words(value), 1e3 * x, 1e3 * y, 1e3 * z,
                                  t > 0.0 ? fmt::format("at t = {}", format_quantity(t, Dimension::time))
                                          : "at the start"),
                      allowed.expected, allowed.example);
          return false;
        }
    return true;
  };
  if (!look(0.0, extent.at) || !formula.uses_time()) return;
  Points fewer;
  for (std::size_t a = 0; a < 3; ++a) fewer[a] = thinned(extent.at[a], kLooksLater);
  for (int n = 1; n <= kLaterTimes; ++n)
    if (!look(extent.until * n / kLaterTimes, fewer)) return;
}

void check_state(const Case& c, const std::string& key, const StateSpec& state, const Extent& extent,
                 Findings& found) {
  if (state.velocity)
    for (const std::string& component : *state.velocity)
      check_formula(key + ".velocity", component, extent,
                    {true, true, "a number everywhere; max(0, ...) keeps a root or logarithm in its range",
                     "velocity = [\"= 10 * sqrt(max(0, 1 - (y/0.02)^2))\", \"0 m/s\", \"0 m/s\"]"},
                    found);
  if (c.flow.solver == FlowSolver::incompressible)
    check_formula(key + ".pressure", state.pressure, extent,
                  {true, true, "a number everywhere", "pressure = \"0 Pa gauge\""}, found);
  if (c.flow.turbulence != TurbulenceModel::laminar) {
    const Allowed eddies{true, false, "nothing below 0 there; max(0, ...) cuts it off",
                         "k = \"= max(0, 0.1 * (1 - (x/0.02)^2))\""};
    check_formula(key + ".k", state.k, extent, eddies, found);
    check_formula(key + ".epsilon", state.epsilon, extent, eddies, found);
  }
  if (c.flow.solver == FlowSolver::incompressible) return;
  check_formula(key + ".pressure", state.pressure, extent,
                {false, false, "a gas has a pressure above 0, absolute", "pressure = \"1 bar absolute\""},
                found);
  check_formula(key + ".density", state.density, extent,
                {false, false, "a gas has a density above 0", "density = \"1.2 kg/m3\""}, found);
  check_formula(key + ".temperature", state.temperature, extent,
                {false, false, "a gas has a temperature above 0 K", "temperature = \"300 K\""}, found);
}

/// A number, or `otherwise` where none is given or a formula stands.
double constant(const std::optional<std::string>& text, double otherwise) {
  if (!text) return otherwise;
  const Expression formula(*text);
  return formula.is_constant() ? formula(0, 0, 0, 0) : otherwise;
}

/// The lowest and the highest of what the states of a gas have in common, with the key that set it.
struct Extremes {
  double low = 1e300, high = 0.0;
  std::string low_key, high_key;
  void add(const std::string& key, double value) {
    if (value < low) low = value, low_key = key;
    if (value > high) high = value, high_key = key;
  }
};

/// States of a gas against each other: a density or pressure in other units, and pressures that drive it
/// faster than the solver goes.
void check_gas(const Case& c, Findings& found) {
  constexpr double temperatures_apart = 100.0;
  Extremes pressures, temperatures;
  const auto take = [&](const std::string& key, BoundaryType type, double total, const StateSpec& s) {
    const bool reservoir = type == BoundaryType::total_pressure;
    const double pressure = reservoir ? total > 0.0 ? total : c.environment.pressure
                                      : constant(s.pressure, c.environment.pressure);
    pressures.add(key + (reservoir ? ".total_pressure" : ".pressure"), pressure);
    if (!reservoir)
      temperatures.add(key + (s.density ? ".density" : ".temperature"),
                       s.density ? pressure / (c.fluid.gas_constant * constant(s.density, c.fluid.density))
                                 : constant(s.temperature, c.environment.temperature));
  };
  const auto open = [](BoundaryType t) {
    return t == BoundaryType::velocity || t == BoundaryType::total_pressure ||
           t == BoundaryType::pressure_outlet || t == BoundaryType::wave_transmissive ||
           t == BoundaryType::free_stream;
  };
  for (std::size_t f = 0; f < 6; ++f) {
    const BoundarySpec& face = c.boundary[f];
    const std::string key = std::string("boundary.") + face_names[f];
    if (open(face.type)) take(key, face.type, face.total_pressure, face.state);
    for (std::size_t n = 0; n < face.patches.size(); ++n)
      if (const PatchSpec& p = face.patches[n]; open(p.type))
        take(fmt::format("{}.patch.{}", key, n), p.type, p.total_pressure, p.state);
  }
  for (std::size_t n = 0; n < c.initial.size(); ++n)
    take(fmt::format("initial.{}", n), BoundaryType::free_stream, 0.0, c.initial[n].state);
  if (c.initial.empty()) take("environment", BoundaryType::free_stream, 0.0, {});
  if (temperatures.low > 0.0 && temperatures.high > temperatures_apart * temperatures.low)
    found.error(
        temperatures.low_key.starts_with("environment") ? temperatures.high_key : temperatures.low_key,
        fmt::format("the gas would be at {:.3g} K in one place and at {:.3g} K in another", temperatures.low,
                    temperatures.high),
        "states of one gas: is the density that of a liquid, or the pressure in another unit?",
        "temperature = \"300 K\"");
  const double g = c.fluid.gamma, critical = std::pow(0.5 * (g + 1.0), g / (g - 1.0));
  if (pressures.low > 0.0 && pressures.high > critical * pressures.low)
    found.error(
        pressures.high_key.starts_with("environment") ? pressures.low_key : pressures.high_key,
        fmt::format(
            "pressures of {} and {} drive the gas to the speed of sound, which \"{}\" does not compute",
            format_quantity(pressures.low, Dimension::pressure_absolute),
            format_quantity(pressures.high, Dimension::pressure_absolute), word(c.flow.solver)),
        fmt::format("at most {:.3g} times the lowest pressure, or \"compressible\" without bodies", critical),
        "solver = \"compressible\"");
}

}  // namespace

void sense_states(const Case& c, Findings& found) {
  const std::optional<Box> box = grid_box(c);
  if (c.flow.solver == FlowSolver::none || !box) return;
  if (c.flow.solver == FlowSolver::compressible_piso && !c.bodies.empty()) check_gas(c, found);
  Points cells;
  for (std::size_t a = 0; a < 3; ++a) cells[a] = thinned(cell_centres(c.grid.axis[a]), kLooksAtFace);
  const auto everywhere = [](const Vec3&) { return true; };
  for (std::size_t f = 0; f < 6; ++f) {
    const BoundarySpec& face = c.boundary[f];
    const std::string key = std::string("boundary.") + face_names[f];
    const int normal = static_cast<int>(f / 2);
    Points at = cells;
    at[f / 2] = {f % 2 ? box->high[normal] : box->low[normal]};
    check_state(c, key, face.state, {at, everywhere, c.run.end_time}, found);
    for (std::size_t n = 0; n < face.patches.size(); ++n) {
      const PatchSpec& p = face.patches[n];
      const std::string patch_key = fmt::format("{}.patch.{}", key, n);
      const auto on_disc = [&](const Vec3& x) { return (x - p.centre).norm() <= p.radius; };
      check_state(c, patch_key, p.state, {at, on_disc, c.run.end_time}, found);
    }
  }
  for (std::vector<double>& along : cells) along = thinned(along, looks_at_region);
  for (std::size_t n = 0; n < c.initial.size(); ++n) {
    const InitialSpec& region = c.initial[n];
    const auto inside = [&](const Vec3& x) {
      if (!region.box) return true;
      const Vec3 low = (*region.box)[0].cwiseMin((*region.box)[1]);
      const Vec3 high = (*region.box)[0].cwiseMax((*region.box)[1]);
      return Box{low, high}.contains(x);
    };
    check_state(c, fmt::format("initial.{}", n), region.state, {cells, inside}, found);
  }
}

}  // namespace ejecta
