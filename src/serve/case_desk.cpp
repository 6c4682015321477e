#include "serve/case_desk.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <optional>

#include "base/error.hpp"
#include "base/units.hpp"
#include "case/documented.hpp"
#include "case/load.hpp"
#include "case/node_path.hpp"
#include "case/schema.hpp"
#include "case/toml.hpp"
#include "shape/stl.hpp"
#include "simulation/body_checks.hpp"
#include "simulation/drawing.hpp"
#include "simulation/forecast.hpp"
#include "simulation/prospect.hpp"

namespace ejecta {
namespace {

using Json = nlohmann::ordered_json;

Json key_json(const Key& key) {
  Json j{{"name", key.name},          {"help", key.help},
         {"takes", expectation(key)}, {"default", default_words(key)},
         {"example", example(key)},   {"units", known_units(key.dimension)}};
  j["factors"] = Json::array();
  for (const std::string& unit : known_units(key.dimension))
    j["factors"].push_back(to_si(1.0, unit, key.dimension).value_or(0.0));
  if (!key.source.empty()) j["source"] = key.source;
  if (const auto* choice = std::get_if<Choice>(&key.slot)) {
    j["words"] = Json::object();
    for (const Word& w : *choice->words) j["words"][w.name] = w.help;
  }
  if (std::holds_alternative<bool*>(key.slot) || std::holds_alternative<std::optional<bool>*>(key.slot))
    j["yes_or_no"] = true;
  return j;
}

/// Every key of the case as it stands, in the words of its text where it is there. `root`: of the text.
Json values_of(Case c, const Node& root) {
  Json values = Json::object();
  for (const Section& s : sections(c))
    for (std::size_t n = 0; n < s.count(); ++n)
      for (const Key& key : s.keys(n)) {
        const std::string path =
            s.repeated ? fmt::format("{}.{}.{}", s.name, n, key.name) : s.name + "." + key.name;
        const bool given = c.given.contains(path);
        const Node* written = find_node(root, path);
        const std::string text = written ? std::string(written->place.text()) : value_text(key);
        if (!text.empty() || given) values[path] = {{"text", text}, {"given", given}};
      }
  return values;
}

/// The convex outline of a body from the side, about its centre, m.
Json outline_of_body(const Body& body) {
  constexpr int kCorners = 60;
  Json corners = Json::array();
  for (int n = 0; n < kCorners; ++n) {
    const double angle = 2.0 * std::numbers::pi * n / kCorners;
    const Vec3 towards(std::cos(angle), 0.0, std::sin(angle));
    const Vec3 corner = body.orientation * body.shape.support(body.orientation.conjugate() * towards);
    corners.push_back({corner.x(), corner.z()});
  }
  return corners;
}

Json drawing_with_outlines(const Case& c, const Scene& scene) {
  Json drawing = drawing_of(c, scene);
  const Company company = company_of(scene);
  for (std::size_t n = 0; n < company.bodies.size(); ++n)
    drawing["bodies"][n]["outline"] = outline_of_body(company.bodies[n]);
  return drawing;
}

Json commands_for(const Case& c) {
  if (c.campaign.enabled) return {"campaign"};
  if (c.sorter.enabled) return {"sort"};
  Json commands{"run"};
  if (c.study.enabled) commands.push_back("study");
  if (c.map.enabled) commands.push_back("map");
  return commands;
}

}  // namespace

Json form_of_schema() {
  Case c = documented_case();
  Json all = Json::array();
  for (const Section& s : sections(c)) {
    Json keys = Json::array();
    for (const Key& key : s.keys(0)) keys.push_back(key_json(key));
    all.push_back({{"name", s.name}, {"help", s.help}, {"repeated", s.repeated}, {"keys", keys}});
  }
  return all;
}

Json judge_case(const std::string& text, const std::string& path, double bandwidth) {
  Json answer{{"problems", Json::array()}};
  const auto tell = [&](const std::vector<Problem>& list) {
    for (const Problem& p : list) answer["problems"].push_back(problem_json(p));
  };
  std::vector<Problem> problems, warnings, told_already;
  std::optional<Scene> scene;
  try {
    const FurtherChecks further = [&](const Case& of) { return check_set_up(of, &scene); };
    const Case c = examine_case(text, path, {}, problems, &warnings, further);
    tell(problems);
    answer["commands"] = commands_for(c);
    answer["values"] = values_of(c, parse_toml(std::make_shared<Source>(Source{path, text}), told_already));
    if (scene && problems.empty()) {
      answer.update(Json{{"check", check_json(c, *scene, {}, bandwidth)},
                         {"drawing", drawing_with_outlines(c, *scene)}});
    }
    tell(warnings);
  } catch (const InputError& e) {  // no text at all, or of what cannot be built
    tell(problems_of(e));
  }
  return answer;
}

Json extent_of_stl(const std::string& bytes, const std::string& name) {
  const TriangleMesh mesh = parse_stl(bytes, 1.0, name);
  if (mesh.triangles.empty()) throw InputError(fmt::format("{} has no triangles", name));
  const Vec3 size = extent_of(mesh);
  return {size.x(), size.y(), size.z()};
}

}  // namespace ejecta
