#pragma once
#include <nlohmann/json.hpp>
#include <vector>

#include "case/case.hpp"
#include "sorter/sorting.hpp"

namespace ejecta {

/// How far a sorter is: what state.json holds, so that the same command goes on from there.
struct SorterState {
  std::int64_t cells = 0;  ///< computed so far
  Products products{};
  double wall_time = 0.0;  ///< s
  /// Pa, of the vessel as each of the last cells came to the valves, and as the next one comes; empty: full.
  std::vector<double> vessel{};
  double lowest_vessel = 1e300;  ///< Pa, so far
};
nlohmann::ordered_json json_of(const SorterState& state);
SorterState sorter_state(const nlohmann::ordered_json& json, std::size_t kinds);

/// result.json of a sorter (docs/files.md).
nlohmann::ordered_json sorter_result(const Case& c, const Sorter& sorter, const SorterState& state);
/// What became of the particles of each class, as a table for Excel.
std::string fates_table(const nlohmann::ordered_json& result);
/// What the report moves: particles, objects and valves of the first length of belt.
nlohmann::ordered_json sorter_view(const Case& c, const SortedStretch& stretch);
/// "Of 4500 particles ...": in a sentence.
std::string sorter_sentence(const nlohmann::ordered_json& result);

}  // namespace ejecta
