#include "case/unknown_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "base/text.hpp"
#include "case/documented.hpp"
#include "case/schema.hpp"

namespace ejecta {
namespace {

/// What may stand in each table: the names of its keys and of the sections below it, by the name of the
/// section without list numbers; "" is the file itself.
using KnownNames = std::map<std::string, std::vector<std::string>>;

KnownNames make_known_names() {
  KnownNames names;
  const auto add = [&](const std::string& table, const std::string& name) {
    std::vector<std::string>& list = names[table];
    if (std::find(list.begin(), list.end(), name) == list.end()) list.push_back(name);
  };
  Case c = documented_case();
  for (const Section& s : sections(c)) {
    std::string table;
    for (std::size_t start = 0; start < s.name.size();) {
      const std::size_t dot = std::min(s.name.find('.', start), s.name.size());
      add(table, s.name.substr(start, dot - start));
      table = s.name.substr(0, dot);
      start = dot + 1;
    }
    for (const Key& key : s.keys(0)) add(s.name, key.name);
  }
  return names;
}

const KnownNames& known_names() {
  static const KnownNames names = make_known_names();
  return names;
}

/// The value's line usually starts with its key: point at the key rather than the value.
Place place_of_key(const Node& node) {
  Place place = node.place;
  const std::string_view line = place.line();
  const std::size_t column = std::min(place.column(), line.size());
  const auto at = line.substr(0, column + node.key.size()).rfind(node.key);
  if (at == std::string_view::npos) return place;
  place.offset = place.offset - place.column() + at;
  place.length = node.key.size();
  return place;
}

/// "run.courant" for "courant", or "courrant", that stands in another section.
std::string name_elsewhere(const std::string& name) {
  std::vector<std::string> all;
  for (const auto& [section, names] : known_names())
    if (!section.empty()) all.insert(all.end(), names.begin(), names.end());
  const std::string close = nearest(name, all);  // the name itself where it is there
  for (const auto& [section, names] : known_names())
    if (!section.empty() && std::find(names.begin(), names.end(), close) != names.end())
      return section + "." + close;
  return "";
}

/// What others call the keys.
constexpr std::array<std::pair<const char*, const char*>, 30> kOtherWords{{
    {"radius", "diameter"},
    {"edge", "size"},
    {"edges", "size"},
    {"length", "size"},
    {"dimensions", "size"},
    {"extents", "size"},
    {"centre", "position"},
    {"center", "position"},
    {"location", "position"},
    {"origin", "position"},
    {"centre", "point"},
    {"center", "point"},
    {"position", "point"},
    {"angular_velocity", "spin"},
    {"omega", "spin"},
    {"dt", "time_step"},
    {"cfl", "courant"},
    {"tend", "end_time"},
    {"duration", "end_time"},
    {"rho", "density"},
    {"mu", "viscosity"},
    {"dynamic_viscosity", "viscosity"},
    {"modulus", "youngs_modulus"},
    {"e_modulus", "youngs_modulus"},
    {"nu", "poisson_ratio"},
    {"cor", "restitution"},
    {"pressure", "supply_pressure"},
    {"stl", "file"},
    {"mesh", "file"},
    {"model", "turbulence"},
}};

std::string other_word(const std::string& name, const std::vector<std::string>& names) {
  for (const auto& [word, key] : kOtherWords)
    if (name == word && std::find(names.begin(), names.end(), key) != names.end()) return key;
  return "";
}

std::string nearest_in(const std::string& section, const std::string& name) {
  const std::vector<std::string>& names = known_names().at(section);
  const std::string close = other_word(name, names);
  return close.empty() ? nearest(name, names) : close;
}

/// What an unknown key or section that stands in `section` was most likely meant to be, or "". Of a section
/// with a single key, as --set writes it, that key.
std::string meant_by(const Node& unknown, const std::string& section) {
  const std::string close = nearest_in(section, unknown.key);
  const bool single = unknown.is_table() && unknown.children.size() == 1;
  if (!single) return close.empty() ? name_elsewhere(unknown.key) : close;
  const std::string& key = unknown.children.front().key;
  if (close.empty()) return name_elsewhere(key);
  const std::string other = section.empty() ? close : section + "." + close;
  const std::string inside = known_names().contains(other) ? nearest_in(other, key) : "";
  return inside.empty() ? close : close + "." + inside;
}

void refuse_in(const Node& table, const std::string& section, const std::string& path,
               std::vector<Problem>& problems) {
  const std::vector<std::string>& names = known_names().at(section);
  for (const Node& child : table.children) {
    if (enough(problems)) return;
    const std::string child_section = section.empty() ? child.key : section + "." + child.key;
    const std::string child_path = path.empty() ? child.key : path + "." + child.key;
    if (std::find(names.begin(), names.end(), child.key) == names.end()) {
      problems.push_back({.key = child_path,
                          .what = "unknown key",
                          .expected = "one of " + joined(names),
                          .nearest = meant_by(child, section),
                          .place = place_of_key(child)});
      continue;
    }
    if (!known_names().contains(child_section)) continue;
    if (child.is_table()) refuse_in(child, child_section, child_path, problems);
    for (std::size_t n = 0; child.is_list() && n < child.children.size(); ++n)
      if (child.children[n].is_table())
        refuse_in(child.children[n], child_section, fmt::format("{}.{}", child_path, n), problems);
  }
}

}  // namespace

void refuse_unknown_keys(const Node& root, std::vector<Problem>& problems) {
  refuse_in(root, "", "", problems);
}

}  // namespace ejecta
