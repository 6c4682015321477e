#include "case/documented.hpp"

#include <fmt/format.h>

#include "case/schema.hpp"

namespace ejecta {

Case documented_case() {
  Case c;
  for (const Section& s : sections(c))
    if (s.repeated) s.append();
  return c;
}

std::vector<Section> documented_sections(Case& documented) {
  std::vector<Section> shown = sections(documented);
  std::erase_if(shown, [](const Section& s) {
    return s.name.starts_with("boundary.") && !s.name.starts_with("boundary.x_min");
  });
  return shown;
}

std::string header(const Section& s) {
  if (s.name == "boundary.x_min") return "[boundary.x_min] ... [boundary.z_max]";
  return fmt::format(fmt::runtime(s.repeated ? "[[{}]]" : "[{}]"), s.name);
}

std::string default_words(const Key& key) {
  if (key.required) return "required";
  if (!key.unset.empty()) return key.unset;
  // A supply pressure is thought of as gauge: show the example where it means the default.
  const auto* number = std::get_if<double*>(&key.slot);
  if (number && key.dimension == Dimension::pressure_absolute && !key.example.empty() &&
      parse_quantity(key.example.substr(1, key.example.size() - 2), key.dimension) == **number)
    return key.example;
  const std::string value = value_text(key);
  return value.empty() ? "none" : value;
}

std::vector<std::string> all_keys() {
  Case c = documented_case();
  std::vector<std::string> names;
  for (const Section& s : documented_sections(c))
    for (const Key& key : s.keys(0)) names.push_back(s.name + (s.repeated ? ".0." : ".") + key.name);
  return names;
}

}  // namespace ejecta
