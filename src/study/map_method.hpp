#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "study/margin_process.hpp"

namespace ejecta {

/// A value and the half-width of the interval around it that holds the truth with 95 % probability.
struct Estimate {
  double value = 0.0, error = 0.0;
};

/// The area in which the margin is positive, as far as the runs tell.
struct Outline {
  Estimate area;                  ///< m2, of the whole window
  Estimate half_width;            ///< m, across: largest abs(y)
  Estimate length_before;         ///< m, from x = 0 against x
  Estimate length_behind;         ///< m, from x = 0 along x
  std::vector<Polygon> outline;   ///< where the expected margin is zero; empty where nothing is ejected
  std::vector<Polygon> sure;      ///< ejected with 97.5 % probability
  std::vector<Polygon> possible;  ///< ejected with 2.5 %
  bool reaches_sides = false;     ///< of the window: the area goes on beyond it
  double widest_gap = 0.0;  ///< m, diameter of the largest circle without a run: an island may hide there
};

struct MapSettings {
  Window window;
  bool symmetric = false;    ///< the margin is even in y: runs only at y >= 0, y_low is ignored
  double coarse_cost = 0.0;  ///< of a coarse run over that of a fine one; 0: there are only fine runs
  int first_runs = 12;       ///< spread evenly before the boundary is looked for
  int max_runs = 35;         ///< of both fidelities
  int max_fine = 15;         ///< where there are coarse runs
  double area_error = 0.02;  ///< of the area: the map is finished
  /// Every place has a run of another body of a class: the area is the integral of the chance of ejection,
  /// and what bodies at one place differ by is the noise of the margin.
  bool of_class = false;
  std::uint64_t seed = 1;  ///< of the draws behind the errors
  /// Of a map on a grid: m between runs along and across; otherwise 0.
  double step_x = 0.0, step_y = 0.0;
};

/// Where to run, and how finely.
struct Proposal {
  Point2 at;  ///< m
  Fidelity fidelity = Fidelity::fine;
};

/// A run whose verdict the other runs contradict.
struct Contradiction {
  MapRun run;
  double chance = 0.0;  ///< that the others give to this verdict
};

/// Chooses the places of the runs of a map and tells the area from their margins: ask for places, run them
/// side by side in any order, tell the margins. What is asked and answered depends on the runs alone, not on
/// their order or on threads.
class MapMethod {
 public:
  virtual ~MapMethod() = default;
  /// The next places, at most `count`, none when there are no more. What was asked for and not yet told
  /// counts as a run whose margin is unknown.
  virtual std::vector<Proposal> ask(int count) = 0;
  /// Throws DivergedError for a margin that is no number.
  virtual void tell(const MapRun& run) = 0;
  /// Throws InputError before the first run was told.
  virtual Outline outline() const = 0;
  virtual bool is_finished(const Outline& outline) const = 0;
  virtual std::vector<Contradiction> contradictions() const = 0;
  /// Probability that a fine run ejects, on a raster of the whole window, of a body that comes beside where
  /// it was expected by a normal distribution of these deviations along and across, m. Nothing: not known.
  virtual std::optional<RasterValues> chance_map(const std::array<double, 2>& arrival_error) const = 0;
};

/// Runs on a grid where the settings have its steps; otherwise where they tell most. Throws InputError
/// as their constructors do.
std::unique_ptr<MapMethod> make_map_method(const MapSettings& settings);

}  // namespace ejecta
