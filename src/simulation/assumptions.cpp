#include "simulation/assumptions.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "case/schema.hpp"
#include "jet/source.hpp"
#include "simulation/prospect.hpp"

namespace ejecta {
namespace {

/// The value of this key reaches the result of this case.
bool acts(const Case& c, const std::string& section, std::size_t element, const std::string& key) {
  const bool jet = c.flow.solver != FlowSolver::none && has_jet(c);
  if (section == "valve") {
    const bool law = key == "duration" || key == "rise_time" || key == "fall_time";
    return jet && !(law && c.valve.shape == ValveShape::trace);
  }
  if (section == "sorter.feed" && key.starts_with("lip_"))
    return c.sorter.enabled && c.feed.presentation == Presentation::feeder;
  if (section.starts_with("sorter")) return c.sorter.enabled;
  if (section == "jet") return jet && c.jet.kind == JetKind::self_similar;
  if (section == "flow") return jet;  // laminar by default: of a jet hardly what is meant
  if (section == "launch") return c.launch.enabled;
  if (section == "splitter") return c.splitter.enabled && !c.splitter.edge;
  if (section == "material") {
    const std::string& name = c.materials[element].name;
    return std::any_of(c.bodies.begin(), c.bodies.end(),
                       [&](const BodySpec& b) {
                         return b.motion == Motion::free && b.material == name && !b.density && !b.mass;
                       }) ||
           std::any_of(c.grains.begin(), c.grains.end(),
                       [&](const GrainsSpec& g) { return !g.held && g.material == name && !g.density; });
  }
  return true;
}

/// As one reads it: without the quotes of TOML.
std::string plain(std::string value) {
  std::erase(value, '"');
  return value;
}

std::string reason(const Case& c, const std::string& path, const Key& key) {
  std::string text = key.source;
  if (text.starts_with("assumption")) text.erase(0, std::string("assumption").size());
  if (text.starts_with(": ")) text.erase(0, 2);
  if (path == "valve.rise_time") {
    const ValveProspect v = prospect_of_valve(c);
    text += fmt::format("{}the valve opens to {:.0f} % within its pulse of {:.3g} ms",
                        text.empty() ? "" : "; ", 100 * v.widest, 1e3 * c.valve.duration);
  }
  return text;
}

/// visit(section, number of its table, key, path) for every key of a case.
template <class Visit>
void for_each_key(Case& c, const Visit& visit) {
  for (const Section& s : sections(c))
    for (std::size_t n = 0; n < s.count(); ++n) {
      const std::string table = s.repeated ? fmt::format("{}.{}", s.name, n) : s.name;
      for (const Key& key : s.keys(n)) visit(s, n, key, table + "." + key.name);
    }
}

}  // namespace

std::vector<output::Input> inputs(const Case& original) {
  Case c = original;  // the schema binds to a case it could change
  std::vector<output::Input> list;
  for_each_key(c, [&](const Section& s, std::size_t, const Key& key, const std::string& path) {
    if (changes_no_result(s.name) || !c.given.contains(path) || path == "run.title" || key.name == "name")
      return;
    const auto* number = std::get_if<double*>(&key.slot);
    const bool supply = number && key.dimension == Dimension::pressure_absolute && s.name == "valve";
    list.push_back({key.help,
                    supply ? format_quantity(**number - c.environment.pressure, Dimension::pressure_gauge)
                           : plain(value_text(key)),
                    path});
  });
  return list;
}

std::vector<output::Assumption> assumptions(const Case& original) {
  Case c = original;  // the schema binds to a case it could change
  std::vector<output::Assumption> list;
  for_each_key(c, [&](const Section& s, std::size_t n, const Key& key, const std::string& path) {
    if (!key.decisive || c.given.contains(path) || !acts(original, s.name, n, key.name)) return;
    list.push_back({key.help, plain(value_text(key)), reason(original, path, key), path});
  });
  return list;
}

}  // namespace ejecta
