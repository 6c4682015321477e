#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/text.hpp"
#include "case/expression.hpp"
#include "case/extent.hpp"
#include "case/findings.hpp"

/// What `ejecta validate` needs.
namespace ejecta {
namespace {

void cells_stay_whole(const Case& c, Findings& found) {
  for (const AxisSpec& axis : c.grid.axis)
    for (int n : axis.cells)
      for (double factor : c.convergence.factors) {
        const bool refined = axis.cells.size() > 1 || n > 1;
        if (!refined || std::abs(n * factor - std::round(n * factor)) < 1e-9) continue;
        found.error("convergence.factors", fmt::format("{} cells times {:g} is no whole number", n, factor),
                    "factors that keep cells whole, or an order says nothing", "factors = [1, 2, 4]");
        return;
      }
}

bool holds(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Parts of a JSON pointer.
std::vector<std::string> steps_of(const std::string& pointer) {
  std::vector<std::string> steps;
  for (const char c : pointer)
    if (c == '/') steps.emplace_back();
    else if (!steps.empty()) steps.back() += c;
  return steps;
}

/// What a run with bodies says of each (simulation/coupled_result.cpp::body_json), and of which three
/// numbers.
const std::vector<std::string> kOfBody{"name",
                                       "mass_kg",
                                       "presence",
                                       "max_overlap_m",
                                       "max_contact_force_N",
                                       "contact_time_s",
                                       "peak_speed_m_s",
                                       "velocity_change_z_m_s",
                                       "impulse_x_N_s",
                                       "impulse_y_N_s",
                                       "impulse_z_N_s"};
const std::vector<std::string> kVectorsOfBody{
    "final_position_m", "final_velocity_m_s", "final_spin_rad_s", "final_spin_body_rad_s",
    "mean_force_N",     "mean_friction_N",    "mean_torque_N_m"};

/// What stands at the top of the result of one kind of run or another.
const std::vector<std::string> kOfRun{"title",
                                      "outcome",
                                      "plate",
                                      "bodies",
                                      "cells",
                                      "steps",
                                      "flow_steps",
                                      "simulated_time_s",
                                      "wall_time_s",
                                      "threads",
                                      "cell_steps_per_s",
                                      "max_courant",
                                      "ledger",
                                      "air_momentum_N_s",
                                      "air_kinetic_energy_J",
                                      "operators",
                                      "inputs",
                                      "assumptions",
                                      "probes",
                                      "lines",
                                      "grains",
                                      "errors",
                                      "warnings",
                                      "fastest_m_s",
                                      "observed_order",
                                      "observed_orders",
                                      "orifice",
                                      "shocks",
                                      "round_jet",
                                      "far_field",
                                      "at_stand_off",
                                      "compressible",
                                      "incompressible",
                                      "momentum",
                                      "spacing",
                                      "stand_off_m"};

/// A quantity of a body or a probe that no run of this case computes is told with the nearest that is.
void quantity_exists(const Case& c, const std::string& quantity, const std::string& key, Findings& found) {
  const std::vector<std::string> steps = steps_of(quantity);
  const auto refuse = [&](std::size_t step, const std::string& what, const std::vector<std::string>& names) {
    std::string example = nearest(steps[step], names), path;
    if (example.empty() && !names.empty()) example = names.front();
    for (std::size_t n = 0; n < steps.size(); ++n) path += "/" + (n == step ? example : steps[n]);
    found.error(key, what, names.empty() ? "" : "one of: " + joined(names),
                example.empty() ? "" : fmt::format("quantity = \"{}\"", path));
  };
  if (!steps.empty() && !holds(kOfRun, steps[0]) && !nearest(steps[0], kOfRun).empty())
    return refuse(0, fmt::format("no run computes \"{}\"", steps[0]), kOfRun);
  if (steps.size() == 1 && steps[0] == "outcome" && !c.splitter.enabled)
    return found.error(key, "without a plate there is no outcome", "a [splitter]",
                       "[splitter] height = \"18 mm\"");
  if (steps.size() > 1 && steps[0] == "probes") {
    std::vector<std::string> names;
    for (const ProbeSpec& p : c.probes) names.push_back(p.name);
    if (!holds(names, steps[1]))
      names.empty()
          ? found.error(key, fmt::format("the case has no probe \"{}\"", steps[1]),
                        "a [[probe]] of that name", fmt::format("[[probe]] name = \"{}\"", steps[1]))
          : refuse(1, fmt::format("the case has no probe \"{}\"", steps[1]), names);
  }
  if (steps.size() < 2 || steps[0] != "bodies") return;
  int bodies = 0, body = -1;
  for (const BodySpec& b : c.bodies) bodies += b.copies;
  const auto [end, error] = std::from_chars(steps[1].data(), steps[1].data() + steps[1].size(), body);
  if (error != std::errc() || *end != '\0' || body < 0 || body >= bodies)
    return found.error(
        key, fmt::format("the case has no body {}", steps[1]),
        bodies > 0 ? fmt::format("a body by its number, from 0 to {}", bodies - 1) : "a [[body]]",
        bodies > 0 ? "quantity = \"/bodies/0/final_velocity_m_s/2\"" : "");
  if (steps.size() < 3) return;
  std::vector<std::string> names = kOfBody;
  names.insert(names.end(), kVectorsOfBody.begin(), kVectorsOfBody.end());
  if (std::any_of(c.bodies.begin(), c.bodies.end(),
                  [](const BodySpec& b) { return !b.file.empty() || !b.files.empty(); }))
    names.insert(names.end(), {"parts", "volume_of_parts_over_solid"});
  if (c.stream.enabled)
    names.insert(names.end(), {"drag_coefficient", "lift_over_drag", "torque_over_drag_length"});
  if (c.splitter.enabled)
    names.insert(names.end(),
                 {"outcome", "clearance_at_splitter_m", "velocity_margin_z_m_s", "time_at_splitter_s",
                  "thrown_back_by_plate", "flight_clearance_m", "wanted", "judgement"});
  if (!holds(names, steps[2]))
    return refuse(2, fmt::format("no run of this case computes \"{}\" of a body", steps[2]), names);
  const bool vector = holds(kVectorsOfBody, steps[2]);
  const std::vector<std::string> components{"0", "1", "2"};
  if (vector && steps.size() == 3)
    found.error(key, fmt::format("{} has three components", steps[2]), "one of them: 0, 1, 2 (x, y, z)",
                fmt::format("quantity = \"{}/2\"", quantity));
  else if (vector && !holds(components, steps[3]))
    refuse(3, fmt::format("{} has three components, no \"{}\"", steps[2], steps[3]), components);
}

}  // namespace

void sense_expectations(const Case& c, Findings& found) {
  for (std::size_t n = 0; n < c.expects.size(); ++n) {
    const ExpectSpec& e = c.expects[n];
    const std::string key = fmt::format("expect.{}", n);
    if (!e.quantity.starts_with('/'))
      found.error(key + ".quantity", "not a JSON pointer", "a path that starts with /",
                  "quantity = \"/bodies/0/drag_coefficient\"");
    quantity_exists(c, e.quantity, key + ".quantity", found);
    const bool number = e.tolerance || e.relative_tolerance || e.at_least || e.at_most || e.converging;
    if (!number && e.text.empty())
      found.error(key, "nothing to compare with", "tolerance, relative_tolerance, at_least, at_most or text",
                  "reference = 1.087, relative_tolerance = 0.03");
    if (number && !e.text.empty())
      found.error(key + ".text", "a text and a number at once", "one of the two",
                  fmt::format("text = \"{}\"", e.text));
    if (e.converging && c.convergence.factors.size() < 3)
      found.error(key + ".converging", "it takes three grids to see that changes shrink",
                  "at least three convergence.factors", "factors = [1, 2, 4]");
    if (e.relative_tolerance && e.reference == 0.0)
      found.error(key + ".relative_tolerance", "a relative tolerance about the reference 0 allows nothing",
                  "an absolute tolerance", "tolerance = 0.01");
    if (e.at_least && e.at_most && *e.at_least > *e.at_most)
      found.error(key + ".at_least", "the lower limit is above the upper one", "at_least below at_most",
                  fmt::format("at_least = {}", *e.at_most));
  }
  const auto& factors = c.convergence.factors;
  if (factors.size() == 1)
    found.error("convergence.factors", "one grid shows no order", "at least two factors",
                "factors = [1, 2, 4]");
  for (std::size_t i = 1; i < factors.size(); ++i)
    if (!(factors[i] > factors[i - 1])) {
      found.error("convergence.factors", "factors must ascend", "coarse grids first", "factors = [1, 2, 4]");
      break;
    }
  cells_stay_whole(c, found);
  if (!c.exact.velocity && !c.exact.pressure && !c.exact.density) return;
  if (c.flow.solver == FlowSolver::none)
    return found.error("exact", "an exact flow without a flow", "a flow solver",
                       "[flow] solver = \"incompressible\"");
  const std::optional<Box> box = grid_box(c);
  const auto look = [&](const char* key, const std::string& text) {
    const Expression formula(text);
    constexpr int kLooks = 9;
    for (int n = 0; n < kLooks * kLooks * kLooks; ++n) {
      const Vec3 share((n % kLooks + 0.5) / kLooks, (n / kLooks % kLooks + 0.5) / kLooks,
                       (n / (kLooks * kLooks) + 0.5) / kLooks);
      const Vec3 x = box->low + share.cwiseProduct(box->high - box->low);
      if (std::isfinite(formula(x.x(), x.y(), x.z(), c.run.end_time))) continue;
      return found.error(fmt::format("exact.{}", key),
                         fmt::format("the formula gives no number at x, y, z = {:.4g}, {:.4g}, {:.4g} mm",
                                     1e3 * x.x(), 1e3 * x.y(), 1e3 * x.z()),
                         "a number everywhere in the box", std::string(key) + " = \"= exp(-t) * sin(x)\"");
    }
  };
  if (!box) return;
  if (c.exact.velocity)
    for (const std::string& component : *c.exact.velocity) look("velocity", component);
  if (c.exact.pressure) look("pressure", *c.exact.pressure);
  if (c.exact.density) look("density", *c.exact.density);
}

}  // namespace ejecta
