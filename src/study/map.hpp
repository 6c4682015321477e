#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "base/text.hpp"
#include "case/case.hpp"
#include "case/load.hpp"
#include "study/task_store.hpp"

namespace ejecta {

/// What a map needs of those who know how to run.
struct MapWorkers {
  /// Works on these tasks until none is left; false: was stopped.
  std::function<bool(const TaskStore&, std::span<const std::size_t>)> run;
  /// What rooms that know more have against a run.
  FurtherChecks further{};
  /// Where a key stands in the case file.
  std::function<Place(const std::string& key)> place{};
  /// Is shown the map after every few runs, and at its end.
  std::function<void(const nlohmann::ordered_json&)> show{};
  Note note{};
};

/// contradicted: at its end, but some run stands against the others, or a claimed symmetry against its check.
enum class MapEnd { finished, runs_used_up, contradicted, stopped };

/// Finds the places around the jet from which the body is ejected ([map]). Which runs are made depends on
/// what the earlier ones gave, in the order in which they were asked for, and on nothing else: a map that is
/// started again finds its runs done and goes on. result.json of the store's directory is written after every
/// few runs. Throws InputError before the first run where one at the rim of the window is refused.
MapEnd make_map(const Case& base, TaskStore& store, const MapWorkers& workers);

}  // namespace ejecta
