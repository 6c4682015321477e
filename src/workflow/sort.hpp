#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "case/case.hpp"
#include "simulation/sorter_result.hpp"
#include "workflow/attendance.hpp"

namespace ejecta {

struct SortOptions {
  std::string out{};              ///< directory; empty: the name of the case with ".sort"
  std::filesystem::path program;  ///< `ejecta`, which runs the resolved shots
  int threads = 0;                ///< 0: as many as the machine has
  int resolved = 0;               ///< shots that are computed as runs
  bool force = false;             ///< start anew
};

struct SortEnd {
  bool stopped = false;
  std::filesystem::path directory;
  nlohmann::ordered_json result{};  ///< result.json
};
/// A whole sorter, which goes on with what is in its directory. Throws InputError.
SortEnd compute_sorter(const Case& c, const SortOptions& options, const Attendance& who);

/// Computes shots drawn at random as runs and corrects the fast tier's products with what they find more or
/// less (a control variate): the shares of result.json with their intervals. Nothing where it was stopped.
nlohmann::ordered_json resolve_shots(const Case& c, const Sorter& sorter, const SorterState& state,
                                     const std::filesystem::path& directory, const SortOptions& options,
                                     const Attendance& who);

}  // namespace ejecta
