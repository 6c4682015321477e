#include "simulation/case_changes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <sstream>
#include <string_view>

namespace ejecta {
namespace {

constexpr std::array<std::string_view, 6> kFree{"run.title",   "run.until", "run.end_time",
                                                "checkpoint.", "expect.",   "convergence."};

/// "section.key" -> value of a text of one line a key.
std::map<std::string, std::string> values_of(const std::string& toml) {
  std::map<std::string, std::string> values;
  std::map<std::string, int> repeated;
  std::string section;
  std::istringstream lines(toml);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("# ")) line.erase(0, 2);  // a default
    if (line.starts_with("[[")) {
      const std::string name = line.substr(2, line.find(']') - 2);
      section = fmt::format("{}.{}", name, repeated[name]++);
    } else if (line.starts_with('[')) {
      section = line.substr(1, line.find(']') - 1);
    } else if (const std::size_t equals = line.find(" = "); equals != std::string::npos) {
      values[section + '.' + line.substr(0, equals)] = line.substr(equals + 3);
    }
  }
  return values;
}

}  // namespace

std::vector<std::string> changed_keys(const std::string& before, const std::string& after) {
  const auto was = values_of(before), is = values_of(after);
  std::vector<std::string> changed;
  const auto collect = [&](const auto& here, const auto& there) {
    for (const auto& [key, value] : here) {
      const auto other = there.find(key);
      const bool free = std::any_of(kFree.begin(), kFree.end(),
                                    [&](std::string_view start) { return key.starts_with(start); });
      if (!free && (other == there.end() || other->second != value)) changed.push_back(key);
    }
  };
  collect(was, is);
  collect(is, was);
  std::sort(changed.begin(), changed.end());
  changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
  return changed;
}

}  // namespace ejecta
