#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "simulation/sorter_result.hpp"
#include "simulation/sorter_shot.hpp"
#include "sorter/sorting.hpp"

namespace ejecta {

/// Shots drawn at random: first a cell of the belt, then one of its shots.
struct DrawnShots {
  /// A shot that has to be computed, and where it was found.
  struct Run {
    std::int64_t cell = 0;
    std::size_t which = 0;
    Shot shot{};
  };
  std::vector<Run> runs;  ///< each once, however often it was drawn
  struct Draw {
    int run = -1;         ///< -1: there is nothing to be computed in that cell
    double weight = 0.0;  ///< how many shots of the machine it stands for
  };
  std::vector<Draw> draws;
};
/// Throws InputError for feeds whose particles may lie in each other.
DrawnShots draw_shots(const Case& c, const Sorter& sorter, const SorterState& state, int count);

/// What became of a shot's run: its bodies, or why there are none.
struct ResolvedShot {
  std::vector<ResolvedBody> bodies;
  std::string failure;  ///< empty: there are some
};
/// Corrects the fast tier's products with what the runs eject more or less (a control variate,
/// docs/theory/sorter.md): the shares of result.json with their 95 % intervals, the fast tier's errors, and
/// what failed. outcome(n): of run n.
nlohmann::ordered_json corrected_products(const Case& c, const SorterState& state, const DrawnShots& drawn,
                                          const std::function<ResolvedShot(std::size_t)>& outcome);

}  // namespace ejecta
