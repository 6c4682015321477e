#include "output/verdict.hpp"

#include <fmt/format.h>

#include <cmath>

namespace ejecta::output {
namespace {

using nlohmann::ordered_json;

bool has_number(const ordered_json& j, const char* key) { return j.contains(key) && j[key].is_number(); }

/// "ejected, 31.2 mm above the plate's edge (vertical velocity 0.35 m/s beyond what clears it)"
std::string of_body(const ordered_json& body) {
  std::string text = body["outcome"].get<std::string>();
  if (has_number(body, "clearance_at_splitter_m")) {
    const double mm = 1e3 * body["clearance_at_splitter_m"].get<double>();
    text += fmt::format(", passing {:.1f} mm {} the plate's edge", std::abs(mm), mm >= 0 ? "above" : "below");
  }
  if (has_number(body, "velocity_margin_z_m_s")) {
    const double margin = body["velocity_margin_z_m_s"].get<double>();
    text += fmt::format(" with {:.2f} m/s {} what clears it", std::abs(margin),
                        margin >= 0 ? "more than" : "less than");
  }
  return text;
}

}  // namespace

std::string verdict_sentence(const ordered_json& result) {
  std::string text;
  if (result.contains("bodies"))
    for (const ordered_json& body : result["bodies"])
      if (body.contains("outcome") && body["outcome"].is_string())
        text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", body.value("name", "body"), of_body(body));
  if (!text.empty()) return text + '.';
  if (result.contains("expectations")) {
    const ordered_json& all = result["expectations"];
    std::size_t passed = 0;
    for (const ordered_json& e : all) passed += e.value("pass", false);
    return fmt::format("{} of {} expected values met.", passed, all.size());
  }
  if (has_number(result, "simulated_time_s"))
    return fmt::format("Computed {:.4g} ms.", 1e3 * result["simulated_time_s"].get<double>());
  return "Computed.";
}

}  // namespace ejecta::output
