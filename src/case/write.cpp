#include "case/write.hpp"

#include <fmt/format.h>

#include "case/schema.hpp"

namespace ejecta {

std::string write_case(const Case& original) {
  Case c = original;  // the schema binds to a case it could change
  std::string text;
  for (const Section& s : sections(c)) {
    if (s.enabled && !*s.enabled) continue;
    for (std::size_t n = 0; n < s.count(); ++n) {
      std::string lines;
      for (const Key& key : s.keys(n))
        if (const std::string value = value_text(key); !value.empty())
          lines += key.name + " = " + value + "\n";
      if (lines.empty() && !s.repeated) continue;
      text += fmt::format(fmt::runtime(s.repeated ? "{}[[{}]]\n{}" : "{}[{}]\n{}"), text.empty() ? "" : "\n",
                          s.name, lines);
    }
  }
  return text;
}

}  // namespace ejecta
