#pragma once
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "case/case.hpp"
#include "simulation/sorter_result.hpp"

namespace ejecta {

struct SortOptions {
  std::string out;     ///< directory; empty: the name of the case with ".sort"
  int threads = 0;     ///< 0: as many as the machine has
  int resolved = 0;    ///< shots that are computed as runs
  bool force = false;  ///< start anew
  bool quiet = false;
};

/// `ejecta sort`. Returns an ExitCode.
int sort_case(const Case& c, const SortOptions& options);

struct ResolvedOptions {
  int shots = 0;
  std::function<bool()> stop{};
};
/// Computes shots drawn at random as runs and corrects the fast tier's products with what they find more or
/// less (a control variate): the shares of result.json with their intervals. Nothing where it was stopped.
nlohmann::ordered_json resolve_shots(const Case& c, const Sorter& sorter, const SorterState& state,
                                     const std::filesystem::path& directory, const ResolvedOptions& options);

}  // namespace ejecta
