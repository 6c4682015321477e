#include "output/result_words.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>
#include <utility>

namespace ejecta::output {
namespace {

constexpr std::array<std::pair<const char*, const char*>, 11> kWords{{
    {"ejected", "The body's centre passes above the edge of the dividing plate; else it is not ejected"},
    {"undecided", "The time limit came before the body had reached the plate: give run.end_time more"},
    {"clearance",
     "How far above the plate's edge the body's centre passes (below: negative), m. The flight "
     "clearance leaves out the blow of a plate that it strikes"},
    {"margin",
     "Gain in vertical velocity beyond what just clears the plate's edge (short of it: negative), "
     "m/s. In maps and in Python: the flight clearance"},
    {"judgement", "The verdict against what body.wanted says: right, by-catch or missed"},
    {"by-catch", "Ejected, and should not be"},
    {"missed", "Not ejected, and should be"},
    {"recovery", "Sorter: of what is to be ejected, the share that is"},
    {"purity", "Sorter: of the ejected product, the share that belongs there"},
    {"loss", "Sorter: of what is to be kept, the share that is ejected"},
    {"fate", "Sorter: what became of a particle, and why"},
}};

}  // namespace

std::string explain_result(const std::string& word) {
  std::string text;
  if (word.empty()) return text;
  for (const auto& [name, meaning] : kWords)
    if (std::string_view(name).find(word) != std::string_view::npos)
      text += fmt::format("  {:<10} {}\n", name, meaning);
  return text.empty() ? text : "Words of results like \"" + word + "\":\n" + text;
}

}  // namespace ejecta::output
