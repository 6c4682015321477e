#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/text.hpp"

#include "case/documented.hpp"
#include "case/explain.hpp"
#include "case/extends.hpp"
#include "case/schema.hpp"

namespace ejecta {
namespace {

using Json = nlohmann::ordered_json;

Json list_of(Json item, std::size_t count = 0) {
  Json list{{"type", "array"}, {"items", std::move(item)}};
  if (count > 0) list["minItems"] = list["maxItems"] = count;
  return list;
}

/// The JSON type of each kind of slot.
struct TypeOf {
  const Key& key;
  Json number() const {
    if (key.dimension != Dimension::none)
      return {{"type", "string"}, {"pattern", fmt::format("^{}$", quantity())}};
    Json type{{"type", "number"}};
    return bounded(type);
  }
  Json integer() const { return bounded({{"type", "integer"}}); }
  Json text() const { return {{"type", "string"}}; }
  Json one_or_more(const Json& item) const { return {{"anyOf", {item, list_of(item)}}}; }

  Json operator()(const bool*) const { return {{"type", "boolean"}}; }
  Json operator()(const std::optional<bool>*) const { return {{"type", "boolean"}}; }
  Json operator()(const int*) const { return integer(); }
  Json operator()(const std::int64_t*) const { return integer(); }
  Json operator()(const double*) const { return number(); }
  Json operator()(const std::optional<double>*) const { return number(); }
  Json operator()(const std::string*) const { return text(); }
  Json operator()(const Vec3*) const { return list_of(number(), 3); }
  Json operator()(const std::vector<double>*) const { return one_or_more(number()); }
  Json operator()(const std::vector<int>*) const { return one_or_more(integer()); }
  Json operator()(const std::vector<std::string>*) const { return one_or_more(text()); }
  Json operator()(const std::array<int, 3>*) const { return list_of(integer(), 3); }
  Json operator()(const std::array<double, 2>*) const { return list_of(number(), 2); }
  Json operator()(const std::optional<std::array<double, 2>>*) const { return list_of(number(), 2); }
  Json operator()(const std::vector<std::array<double, 4>>*) const { return list_of(list_of(number(), 4)); }
  Json operator()(const std::vector<Vec3>*) const { return list_of(list_of(number(), 3)); }
  Json operator()(const std::optional<std::array<Vec3, 2>>*) const {
    return list_of(list_of(number(), 3), 2);
  }
  Json operator()(const std::vector<Node>*) const { return {{"type", "array"}}; }
  Json operator()(const std::optional<Node>*) const { return Json::object(); }
  Json operator()(const Formula&) const { return formula(); }
  Json operator()(const Formulas&) const { return list_of(formula(), 3); }
  Json operator()(const VectorOrFormulas&) const { return list_of(formula(), 3); }
  Json operator()(const Choice& c) const {
    Json names = Json::array();
    for (const Word& w : *c.words) names.push_back(w.name);
    return {{"type", "string"}, {"enum", names}};
  }

 private:
  /// Pattern of a number with one of the units.
  std::string quantity() const {
    std::vector<std::string> units = known_units(key.dimension);
    for (std::string& unit : units)
      for (std::size_t at = 0; (at = unit.find('.', at)) != std::string::npos; at += 2) unit.insert(at, "\\");
    return fmt::format(R"(\s*[-+]?[0-9.]+([eE][-+]?[0-9]+)?\s*({})\s*)", joined(units, "|"));
  }
  Json formula() const {
    return {{"type", "string"}, {"pattern", fmt::format(R"(^(\s*=.*|{})$)", quantity())}};
  }
  Json bounded(Json type) const {
    const Bounds& b = key.bounds;
    if (b.least > -1e300) type[b.open ? "exclusiveMinimum" : "minimum"] = b.least;
    if (b.most < 1e300) type["maximum"] = b.most;
    return type;
  }
};

Json& properties(Json& object) { return object["properties"]; }

/// The object of a dotted section name, made on the way; lists are entered through their items.
Json& place(Json& root, const std::string& name) {
  Json* node = &root;
  for (std::size_t start = 0; start < name.size();) {
    const std::size_t dot = std::min(name.find('.', start), name.size());
    Json& next = properties(*node)[name.substr(start, dot - start)];
    if (next.is_null())
      next = {{"type", "object"}, {"additionalProperties", false}, {"properties", Json::object()}};
    node = next.contains("items") ? &next["items"] : &next;
    start = dot + 1;
  }
  return *node;
}

}  // namespace

std::string json_schema() {
  Case c = documented_case();
  Json root{{"$schema", "http://json-schema.org/draft-07/schema#"},
            {"title", "Ejecta case"},
            {"type", "object"},
            {"additionalProperties", false},
            {"properties", Json::object()}};
  properties(root)["extends"] = {{"type", "string"}, {"description", kExtendsHelp}};
  for (const Section& s : sections(c)) {
    Json& object = place(root, s.name);
    object["description"] = s.help;
    Json required = Json::array();
    for (const Key& key : s.keys(0)) {
      Json type = std::visit(TypeOf{key}, key.slot);
      type["description"] = key.help + ". Takes " + expectation(key) + ". Default: " + default_words(key);
      properties(object)[key.name] = type;
      if (key.required) required.push_back(key.name);
    }
    if (!required.empty()) object["required"] = required;
    if (s.repeated) object = Json{{"type", "array"}, {"description", s.help}, {"items", Json(object)}};
  }
  return root.dump(1) + "\n";
}

}  // namespace ejecta
