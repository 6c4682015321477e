#pragma once
#include <fmt/format.h>

#include <filesystem>
#include <string>

#include "case/case.hpp"
#include "case/findings.hpp"
#include "case/load.hpp"
#include "case/words.hpp"

namespace ejecta {

/// Whether the file that `key` needs is there.
inline void need_file(const Case& c, const std::string& key, const std::string& file,
                      const std::string& example, Findings& found) {
  std::error_code none;
  if (file.empty())
    found.error(key, "missing: the file", "a file, relative to the folder of the case", example);
  else if (!std::filesystem::is_regular_file(beside_case(c, file), none))
    found.error(key, fmt::format("there is no file \"{}\"", beside_case(c, file)),
                "a file, relative to the folder of the case", example);
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
  if (by_sieves) need_file(c, at + "sieves", s.sieves, "sieves = \"sieves.csv\"", found);
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
