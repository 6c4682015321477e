#pragma once
#include <fmt/format.h>

#include <string>

#include "case/case.hpp"
#include "case/findings.hpp"
#include "case/words.hpp"

namespace ejecta {

/// Whether a law of sizes has what it needs (`size_to`, `spread`) and nothing that it does not read. `at`:
/// the section with its dot; `example`: an upper end.
template <class Spec>
void check_size_law(const Spec& s, const std::string& at, const std::string& example, Findings& found) {
  const bool spreads = s.sizes == SizeLaw::lognormal || s.sizes == SizeLaw::rosin_rammler;
  if (s.sizes == SizeLaw::uniform && !(s.size_to > s.size))
    found.error(at + "size_to", "the sizes have no upper end above `size`", "a length, more than `size`",
                fmt::format("size_to = \"{}\"", example));
  if (spreads && !(s.spread > 0.0))
    found.error(at + "spread", fmt::format("sizes that are \"{}\" need it", word(s.sizes)),
                "a number, more than 0", "spread = 0.3");
  const auto idle = [&](bool given, const char* key, const char* law) {
    if (given)
      found.error(at + key, fmt::format("`{}` does nothing here: sizes are \"{}\"", key, word(s.sizes)),
                  fmt::format("sizes = \"{}\", or no {}", law, key), fmt::format("sizes = \"{}\"", law));
  };
  idle(s.sizes != SizeLaw::uniform && s.size_to > 0.0, "size_to", "uniform");
  idle(!spreads && s.spread > 0.0, "spread", "lognormal");
}

}  // namespace ejecta
