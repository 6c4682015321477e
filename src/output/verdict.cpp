#include "output/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace ejecta::output {
namespace {

using nlohmann::ordered_json;

bool has_number(const ordered_json& j, const char* key) { return j.contains(key) && j[key].is_number(); }

/// "cube is ejected: its centre passes 12.3 mm above the plate's edge, with 0.25 m/s of vertical velocity to
/// spare"
std::string of_body(const ordered_json& body) {
  if (body["outcome"] == "undecided") return body.value("name", "the body") + " did not reach the plate";
  std::string text =
      fmt::format("{} is {}", body.value("name", "the body"), body["outcome"].get<std::string>());
  if (has_number(body, "clearance_at_splitter_m")) {
    const double mm = 1e3 * body["clearance_at_splitter_m"].get<double>();
    text += fmt::format(": its centre passes {:.1f} mm {} the plate's edge", std::abs(mm),
                        mm >= 0 ? "above" : "below");
  }
  if (has_number(body, "velocity_margin_z_m_s")) {
    const double margin = body["velocity_margin_z_m_s"].get<double>();
    text += margin >= 0 ? fmt::format(", with {:.2f} m/s of vertical velocity to spare", margin)
                        : fmt::format(", {:.2f} m/s of vertical velocity short of clearing it", -margin);
  }
  return text;
}

/// "300 bodies followed for 3000 ms; at the end the fastest moves at 0.02 m/s"
std::string of_bodies_alone(const ordered_json& result) {
  const ordered_json& bodies = result["bodies"];
  double fastest = 0.0;
  for (const ordered_json& body : bodies) {
    const auto v = body["final_velocity_m_s"].get<std::array<double, 3>>();
    fastest = std::max(fastest, std::hypot(v[0], v[1], v[2]));
  }
  const std::string names =
      bodies.size() == 1 ? bodies[0].value("name", "The body") : fmt::format("{} bodies", bodies.size());
  const std::string end =
      fastest < 1e-3 ? "at rest at the end (below 1 mm/s)"
                     : fmt::format("{} {:.3g} m/s at the end",
                                   bodies.size() == 1 ? "moving at" : "the fastest moving at", fastest);
  return fmt::format("{} followed for {:.4g} ms, {}.", names, 1e3 * result["simulated_time_s"].get<double>(),
                     end);
}

}  // namespace

std::string verdict_sentence(const ordered_json& result) {
  std::size_t judged = 0, ejected = 0;
  std::string sentence, names;
  if (result.contains("bodies"))
    for (const ordered_json& body : result["bodies"]) {
      if (!body.contains("outcome") || !body["outcome"].is_string()) continue;
      sentence = of_body(body);
      ++judged;
      if (body["outcome"] != "ejected") continue;
      names += fmt::format("{}{}", ejected ? ", " : "", body.value("name", "?"));
      ++ejected;
    }
  if (judged == 1) return sentence + '.';
  if (judged > 1)
    return fmt::format("{} of {} bodies {} ejected{}{}.", ejected, judged, ejected == 1 ? "is" : "are",
                       ejected ? ": " : "", names);
  if (result.contains("expectations")) {
    const ordered_json& all = result["expectations"];
    std::size_t passed = 0;
    for (const ordered_json& e : all) passed += e.value("pass", false);
    return fmt::format("{} of {} expected values met.", passed, all.size());
  }
  if (result.contains("at_stand_off") && has_number(result["at_stand_off"], "mach")) {
    const ordered_json& at = result["at_stand_off"];
    return fmt::format(
        "The jet reaches Mach {:.2f} and {:.1f} kPa of total gauge pressure {:.0f} mm from its orifice.",
        at["mach"].get<double>(), 1e-3 * at["total_gauge_Pa"].get<double>(),
        1e3 * at["height_m"].get<double>());
  }
  if (has_number(result, "simulated_time_s") && result.contains("bodies") && !result["bodies"].empty() &&
      result["bodies"][0].contains("final_velocity_m_s"))
    return of_bodies_alone(result);
  if (has_number(result, "simulated_time_s"))
    return fmt::format("Computed {:.4g} ms.", 1e3 * result["simulated_time_s"].get<double>());
  return "Computed.";
}

}  // namespace ejecta::output
