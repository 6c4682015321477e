#include "case/write.hpp"

#include <fmt/format.h>

#include "case/schema.hpp"

namespace ejecta {

namespace {

/// How a key stands in the text.
enum class Writing { plain, as_comment, not_at_all };

/// Each key with a value as `writing(its name with section and element, default as text, value)` says.
template <class Rule>
std::string write_keys(const Case& original, const Rule& writing) {
  Case c = original, blank;  // the schema binds to a case it could change
  std::string text;
  const std::vector<Section> all = sections(c), plain = sections(blank);
  for (std::size_t m = 0; m < all.size(); ++m) {
    const Section& s = all[m];
    if (s.enabled && !*s.enabled) continue;
    for (std::size_t n = 0; n < s.count(); ++n) {
      while (plain[m].count() <= n) plain[m].append();
      const std::string section = s.repeated ? fmt::format("{}.{}.", s.name, n) : s.name + ".";
      std::string lines;
      const std::vector<Key> keys = s.keys(n), defaults = plain[m].keys(n);
      for (std::size_t i = 0; i < keys.size(); ++i) {
        const std::string value = value_text(keys[i]);
        const Writing w = value.empty() ? Writing::not_at_all
                                        : writing(section + keys[i].name, value_text(defaults[i]), value);
        if (w != Writing::not_at_all)
          lines += (w == Writing::as_comment ? "# " : "") + keys[i].name + " = " + value + "\n";
      }
      if (lines.empty() && !s.repeated) continue;
      text += fmt::format(fmt::runtime(s.repeated ? "{}[[{}]]\n{}" : "{}[{}]\n{}"), text.empty() ? "" : "\n",
                          s.name, lines);
    }
  }
  return text;
}

}  // namespace

std::string write_case(const Case& c) {
  return write_keys(c, [&](const std::string& key, const std::string& standard, const std::string& value) {
    return c.given.contains(key) || value != standard ? Writing::plain : Writing::as_comment;
  });
}

std::string write_changes(const Case& c) {
  return write_keys(c, [](const std::string&, const std::string& standard, const std::string& value) {
    return value != standard ? Writing::plain : Writing::not_at_all;
  });
}

}  // namespace ejecta
