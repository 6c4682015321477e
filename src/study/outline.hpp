#pragma once
#include <array>
#include <cstdint>
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

/// Finds where a margin is positive with few runs: ask for places, run them side by side in any order, tell
/// the margins. What is asked and answered depends on the runs alone, not on their order or on threads.
class OutlineFinder {
 public:
  /// Throws InputError for a window without area and numbers of runs that are none.
  explicit OutlineFinder(const MapSettings& settings);

  /// The next places, at most `count`, none when the runs are used up. What was asked for and not yet told
  /// counts as a run whose margin is unknown.
  std::vector<Proposal> ask(int count);
  /// Throws DivergedError for a margin that is no number. Runs that nobody asked for are welcome.
  void tell(const MapRun& run);

  Outline outline() const;
  bool is_finished(const Outline& outline) const;
  /// Probability that a fine run ejects at these places, noise included.
  std::vector<double> chances(std::span<const Point2> places) const;
  /// The same on a raster of the whole window, of a body that comes beside where it was expected by a normal
  /// distribution of these deviations along and across, m.
  RasterValues chance_map(const std::array<double, 2>& arrival_error) const;
  std::vector<Contradiction> contradictions() const;

 private:
  int asked(Fidelity fidelity) const;
  MapSettings settings_;
  std::vector<MapRun> runs_;
  std::vector<Proposal> pending_;
};

}  // namespace ejecta
