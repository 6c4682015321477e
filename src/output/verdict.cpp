#include "output/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace ejecta::output {
namespace {

using nlohmann::ordered_json;

bool has_number(const ordered_json& j, const char* key) { return j.contains(key) && j[key].is_number(); }

/// " of 150 ms", if the result knows it.
std::string limit_words(const ordered_json& result) {
  return has_number(result, "simulated_time_s")
             ? fmt::format(" of {:.4g} ms", 1e3 * result["simulated_time_s"].get<double>())
             : "";
}

/// What the body did, against what was wanted of it: "is ejected, as wanted", "is by-catch, ejected though
/// not wanted".
std::string outcome_words(const ordered_json& body) {
  const std::string outcome = body["outcome"];
  const std::string judgement = body.value("judgement", "");
  if (judgement == "right") return fmt::format("is right: {}, as it should be", outcome);
  if (judgement == "by-catch") return "is by-catch: ejected, and should not be";
  if (judgement == "missed") return "is missed: not ejected, and should be";
  return "is " + outcome;
}

/// "cube is ejected: its centre passes 12.3 mm above the plate's edge, with 0.25 m/s of vertical velocity to
/// spare"
std::string of_body(const ordered_json& body, const ordered_json& result) {
  const std::string name = body.value("name", "the body");
  if (body["outcome"] == "undecided")
    return fmt::format("{} is undecided: the time limit{} came before it reached the plate", name,
                       limit_words(result));
  std::string text = fmt::format("{} {}", name, outcome_words(body));
  if (body.value("thrown_back_by_plate", false)) return text + ": the plate has thrown it back";
  if (has_number(body, "clearance_at_splitter_m")) {
    const double mm = 1e3 * body["clearance_at_splitter_m"].get<double>();
    text += fmt::format("{} its centre passes {:.1f} mm {} the plate's edge",
                        body.contains("judgement") ? ";" : ":", std::abs(mm), mm >= 0 ? "above" : "below");
  }
  if (has_number(body, "velocity_margin_z_m_s")) {
    const double margin = body["velocity_margin_z_m_s"].get<double>();
    text += margin >= 0 ? fmt::format(", with {:.2f} m/s of vertical velocity to spare", margin)
                        : fmt::format(", {:.2f} m/s of vertical velocity short of clearing it", -margin);
  }
  return text;
}

/// "a, b, c and 4 more"
std::string some_of(const std::vector<std::string>& names) {
  constexpr std::size_t shown = 6;
  std::string text;
  for (std::size_t n = 0; n < std::min(shown, names.size()); ++n) text += (n ? ", " : "") + names[n];
  return names.size() > shown ? fmt::format("{} and {} more", text, names.size() - shown) : text;
}

/// Several bodies: how many are what, and which.
std::string of_several(const std::vector<const ordered_json*>& judged, const ordered_json& result) {
  std::map<std::string, std::vector<std::string>> by_word;
  bool wanted = false;
  for (const ordered_json* body : judged) {
    wanted = wanted || body->contains("judgement");
    by_word[body->contains("judgement") ? (*body)["judgement"] : (*body)["outcome"]].push_back(
        body->value("name", "?"));
  }
  const std::vector<std::string>& undecided = by_word["undecided"];
  const std::string late = fmt::format("undecided, since the time limit{} came first", limit_words(result));
  if (!wanted) {
    const std::vector<std::string>& ejected = by_word["ejected"];
    if (undecided.size() == judged.size()) return fmt::format("All {} bodies are {}.", judged.size(), late);
    return fmt::format(
        "{} of {} bodies {} ejected{}{}{}.", ejected.size(), judged.size(),
        ejected.size() == 1 ? "is" : "are", ejected.empty() ? "" : ": ", some_of(ejected),
        undecided.empty() ? "" : fmt::format("; {} {}: {}", undecided.size(), late, some_of(undecided)));
  }
  std::string text;
  for (const char* word : {"right", "by-catch", "missed", "ejected", "not ejected", "undecided"})
    if (const auto& names = by_word[word]; !names.empty())
      text += fmt::format("{}{} {} ({})", text.empty() ? "" : ", ", names.size(),
                          std::string_view(word) == "undecided" ? late : word, some_of(names));
  return fmt::format("Of {} bodies {}.", judged.size(), text);
}

/// "300 bodies followed for 3000 ms; at the end the fastest moves at 0.02 m/s"
std::string of_bodies_alone(const ordered_json& result) {
  const ordered_json& bodies = result["bodies"];
  std::map<std::string, std::vector<std::string>> absent;  // by why
  for (const ordered_json& body : bodies)
    if (body.contains("presence")) absent[body["presence"]].push_back(body.value("name", "?"));
  std::string away;
  for (const auto& [why, names] : absent) away += fmt::format("; {}: {}", why, some_of(names));
  double fastest = 0.0;
  std::size_t here = 0;
  for (const ordered_json& body : bodies) {
    if (body.contains("presence")) continue;
    ++here;
    const auto v = body["final_velocity_m_s"].get<std::array<double, 3>>();
    fastest = std::max(fastest, std::hypot(v[0], v[1], v[2]));
  }
  const std::string names =
      bodies.size() == 1 ? bodies[0].value("name", "The body") : fmt::format("{} bodies", bodies.size());
  const std::string end =
      here == 0        ? "none of them there at the end"
      : fastest < 1e-3 ? "at rest at the end (below 1 mm/s)"
                       : fmt::format("{} {:.3g} m/s at the end",
                                     bodies.size() == 1 ? "moving at" : "the fastest moving at", fastest);
  return fmt::format("{} followed for {:.4g} ms, {}{}.", names,
                     1e3 * result["simulated_time_s"].get<double>(),
                     here == 0 && bodies.size() == 1 ? "not there at the end" : end, away);
}

}  // namespace

std::string verdict_sentence(const ordered_json& result) {
  std::vector<const ordered_json*> judged;
  if (result.contains("bodies"))
    for (const ordered_json& body : result["bodies"])
      if (body.contains("outcome") && body["outcome"].is_string()) judged.push_back(&body);
  if (judged.size() == 1) return of_body(*judged.front(), result) + '.';
  if (judged.size() > 1) return of_several(judged, result);
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

std::vector<std::string> undecided_bodies(const ordered_json& result) {
  std::vector<std::string> names;
  if (result.contains("bodies"))
    for (const ordered_json& body : result["bodies"])
      if (body.contains("outcome") && body["outcome"] == "undecided")
        names.push_back(body.value("name", "?"));
  return names;
}

}  // namespace ejecta::output
