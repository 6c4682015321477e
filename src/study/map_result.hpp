#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "case/case.hpp"
#include "study/map_case.hpp"
#include "study/outline.hpp"
#include "study/task_store.hpp"

namespace ejecta {

/// A run of a map and what came of it.
struct MapPoint {
  Point2 at;
  Fidelity fidelity = Fidelity::fine;
  std::size_t task = 0;
  TaskState state = TaskState::waiting;
  std::optional<MapFlight> flight;  ///< of one that is done
  std::string reason;               ///< of one that failed
  std::string directory;
  double wall_time = 0.0;  ///< s
};

/// The map for a plate that stands elsewhere.
struct MapPlate {
  PlatePlace at;
  Outline outline;
};

/// How the area moved as runs were added.
struct MapHistory {
  int runs = 0;
  Estimate area;
};

/// A run and its mirror image, which was run too.
struct MirrorCheck {
  Point2 at;
  double clearance = 0.0, mirrored = 0.0;  ///< m
  bool contradicts() const { return (clearance > 0.0) != (mirrored > 0.0); }
};

struct MapSummary {
  const Case& base;
  const MapSettings& settings;
  std::string state;
  const Outline& outline;
  const std::vector<MapPlate>& plates;
  const std::vector<MapPoint>& runs;
  const std::vector<MapHistory>& history;
  std::vector<Contradiction> contradictions;
  std::optional<MirrorCheck> mirror;
  std::optional<RasterValues> chance;  ///< of ejection, where the case makes it one
  double wall_time = 0.0;              ///< s
};

/// result.json of a map (docs/files.md).
nlohmann::ordered_json map_result(const MapSummary& map);
/// In one sentence, for the terminal and the head of the report.
std::string map_sentence(const nlohmann::ordered_json& result);

}  // namespace ejecta
