#pragma once
#include <fmt/format.h>

#include <array>
#include <string>
#include <vector>

#include "case/case.hpp"
#include "case/findings.hpp"
#include "case/key.hpp"
#include "case/required_file.hpp"
#include "case/words.hpp"

namespace ejecta {

/// The keys of a law of sizes. `help`: what `size` means; `examples`: of `size` and of `size_to`, as TOML.
template <class Spec>
void append_size_keys(std::vector<Key>& list, Spec& s, const std::string& help,
                      const std::array<std::string, 2>& examples) {
  list.insert(
      list.end(),
      {{"sizes", choice(s.sizes), Dimension::none, anything, "How its sizes are distributed", ""},
       {.name = "size",
        .slot = &s.size,
        .dimension = Dimension::length,
        .bounds = positive,
        .help = help,
        .unset = "from `sieves`",
        .example = examples[0]},
       {.name = "size_to",
        .slot = &s.size_to,
        .dimension = Dimension::length,
        .bounds = positive,
        .help = "Upper end of sizes that are \"uniform\"",
        .unset = "needed for these",
        .example = examples[1]},
       {.name = "spread",
        .slot = &s.spread,
        .bounds = positive,
        .help = "\"lognormal\": standard deviation of ln(size); \"rosin-rammler\": the exponent",
        .unset = "needed for these",
        .example = "0.2"},
       {.name = "sieves",
        .slot = &s.sieves,
        .help = "CSV file with the columns size and finer (share of the mass below it, 0 to 1), sizes "
                "ascending",
        .unset = "none",
        .example = "\"sieves.csv\"",
        .file = true}});
}

/// Whether a law of sizes has what it needs (`size`, `size_to`, `spread`, `sieves`) and nothing that it does
/// not read. `at`: the section with its dot; `example`: an upper end.
template <class Spec>
void check_size_law(const Case& c, const Spec& s, const std::string& at, const std::string& example,
                    Findings& found) {
  const bool spreads = s.sizes == SizeLaw::lognormal || s.sizes == SizeLaw::rosin_rammler;
  const bool by_sieves = s.sizes == SizeLaw::sieves;
  if (!by_sieves && !(s.size > 0.0))
    found.error(at + "size", fmt::format("\"{}\" has no size", s.name), "a length, more than 0",
                "size = \"10 mm\"");
  if (s.sizes == SizeLaw::uniform && !(s.size_to > s.size))
    found.error(at + "size_to", "the sizes have no upper end above `size`", "a length, more than `size`",
                fmt::format("size_to = \"{}\"", example));
  if (spreads && !(s.spread > 0.0))
    found.error(at + "spread", fmt::format("sizes that are \"{}\" need it", word(s.sizes)),
                "a number, more than 0", "spread = 0.3");
  if (by_sieves)
    require_file(c, at + "sieves", s.sieves, "missing: the file", "sieves = \"sieves.csv\"", found);
  const auto idle = [&](bool given, const char* key, const char* law) {
    if (given)
      found.error(at + key, fmt::format("`{}` does nothing here: sizes are \"{}\"", key, word(s.sizes)),
                  fmt::format("sizes = \"{}\", or no {}", law, key), fmt::format("sizes = \"{}\"", law));
  };
  idle(by_sieves && s.size > 0.0, "size", "one");
  idle(s.sizes != SizeLaw::uniform && s.size_to > 0.0, "size_to", "uniform");
  idle(!spreads && s.spread > 0.0, "spread", "lognormal");
  idle(!by_sieves && !s.sieves.empty(), "sieves", "sieves");
}

}  // namespace ejecta
