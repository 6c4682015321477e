#pragma once
#include <nlohmann/json.hpp>
#include <optional>

#include "case/case.hpp"
#include "study/outline.hpp"

namespace ejecta {

/// How a place of the map becomes a run, and a run a margin (docs/theory/maps.md).
///
/// x: where the centre would be, along the belt from the jet's axis, at launch.arrives_at if no air blew. The
/// body flies the same path sooner (x > 0) or later: the shot comes late or early. y: beside the axis.
Case map_run_case(const Case& base, const Proposal& at);

/// The edge of the plate in x and z, m; offsets from where the case has it.
struct PlatePlace {
  double x = 0.0, z = 0.0;
};

/// What a finished run of a map says of its body.
struct MapFlight {
  std::string outcome;
  double x = 0.0, z = 0.0;                    ///< m, centre at the end of the run, from the nozzle
  double velocity_x = 0.0, velocity_z = 0.0;  ///< m/s
  double edge_x = 0.0, edge_z = 0.0;          ///< m, the plate's edge as the case has it, from the nozzle
  double gravity_z = 0.0;                     ///< m/s2

  /// Clearance of the centre above an edge on the parabola that the air gave the body, m. A body that does
  /// not fly on comes to no plate: its clearance is the distance to it, negative.
  double clearance(const PlatePlace& plate = {}) const;
};
MapFlight map_flight(const Case& base, const nlohmann::ordered_json& result);

/// The cost of a coarse run over that of a fine one: cells times steps; 0 where there are only fine runs.
double coarse_cost(const Case& base);

/// Outline of the body seen from above as it lies on the belt, m; empty where only its file knows.
Polygon footprint(const Case& base);

}  // namespace ejecta
