#include "case/write.hpp"

#include <fmt/format.h>

#include "case/schema.hpp"

namespace ejecta {

namespace {

/// The keys that `wanted(section, element, key, value)` asks for.
template <class Wanted>
std::string write_keys(Case& c, const Wanted& wanted) {
  std::string text;
  const std::vector<Section> all = sections(c);
  for (std::size_t m = 0; m < all.size(); ++m) {
    const Section& s = all[m];
    if (s.enabled && !*s.enabled) continue;
    for (std::size_t n = 0; n < s.count(); ++n) {
      std::string lines;
      const std::vector<Key> keys = s.keys(n);
      for (std::size_t i = 0; i < keys.size(); ++i)
        if (const std::string value = value_text(keys[i]); !value.empty() && wanted(m, n, i, value))
          lines += keys[i].name + " = " + value + "\n";
      if (lines.empty() && !s.repeated) continue;
      text += fmt::format(fmt::runtime(s.repeated ? "{}[[{}]]\n{}" : "{}[{}]\n{}"), text.empty() ? "" : "\n",
                          s.name, lines);
    }
  }
  return text;
}

}  // namespace

std::string write_case(const Case& original) {
  Case c = original;  // the schema binds to a case it could change
  return write_keys(c, [](auto...) { return true; });
}

std::string write_changes(const Case& original) {
  Case c = original, blank;
  const std::vector<Section> plain = sections(blank);
  return write_keys(c,
                    [&](std::size_t section, std::size_t element, std::size_t key, const std::string& value) {
                      const Section& s = plain[section];
                      while (s.count() <= element) s.append();
                      return value_text(s.keys(element)[key]) != value;
                    });
}

}  // namespace ejecta
