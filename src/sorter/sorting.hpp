#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "case/case.hpp"
#include "jet/source.hpp"
#include "sorter/air_use.hpp"
#include "sorter/air_vessel.hpp"
#include "sorter/camera.hpp"
#include "sorter/controller.hpp"
#include "sorter/feed.hpp"
#include "sorter/flight.hpp"
#include "sorter/manifold.hpp"
#include "sorter/shot.hpp"
#include "sorter/tally.hpp"

namespace ejecta {

/// A particle as the report shows it.
struct ShownParticle {
  FeedParticle particle;
  Fate fate = Fate::kept;
  std::vector<Vec3> path{};  ///< m, from the jets; empty: the free flight
  double path_from = 0.0;    ///< s, of its first point
};

/// A length of belt with all that happened to it.
struct SortedStretch {
  std::vector<Tally> cells;
  std::vector<ShownParticle> shown{};
  std::vector<SeenObject> objects{};              ///< where particles are shown
  std::vector<std::vector<ValvePulse>> pulses{};  ///< of each valve, likewise
};

/// How a body flies over the jets: a tier of the ejection.
struct Ejection {
  /// `at`: s, when its centre is over the jets if no air blows; y from the middle of the belt; the blows of
  /// all valves within reach; whether its path is kept.
  std::function<FlightEnd(const FeedParticle& particle, double at, double y, std::span<const Blow> blows,
                          bool keep_path)>
      fly;
  std::function<double(const FeedParticle& particle)>
      reach;  ///< m, across, to the axis of a valve it may feel
};
/// The fast tier with the jet of the case.
Ejection fast_ejection(const Case& c, const JetSource& source);

/// The machine: feed -> camera -> controller -> manifold -> flight -> fates. A stretch of belt is a pure
/// function of the case and its place: it is computed with a cell more at either end, so that what lies there
/// sees its neighbours.
class Sorter {
 public:
  Sorter(const Case& c, Ejection ejection);
  /// Cells [first, last); of the first `show` particles everything is kept.
  SortedStretch sort(std::int64_t first, std::int64_t last, int show = 0) const;

  /// Computes side by side what these cells need of each other's feed: optional, for speed.
  void prepare(std::int64_t first, std::int64_t last) const { feed_.prepare(first - 1, last + 1); }

  /// The shots whose objects begin in a cell, each with the particles within its reach, flown by the fast
  /// tier as if no other valve blew.
  std::vector<Shot> shots(std::int64_t cell) const;

  const Feed& feed() const { return feed_; }
  const Camera& camera() const { return camera_; }
  const Manifold& manifold() const { return manifold_; }
  const AirUse& air_use() const { return air_use_; }

 private:
  struct Scene;
  Fate fate_of(const Scene& scene, std::size_t n, FlightEnd* end) const;
  Scene look(std::int64_t first, std::int64_t last) const;
  Shot shot(const Scene& scene, std::span<const ValveCommand> commands, std::size_t which) const;
  FlightEnd fly(const FeedParticle& p, const std::vector<std::vector<ValvePulse>>& pulses, bool as_seen,
                bool keep_path) const;

  Case case_;
  Feed feed_;
  Camera camera_;
  Controller controller_;
  Manifold manifold_;
  Ejection ejection_;
  AirVessel vessel_;
  AirUse air_use_;
};

}  // namespace ejecta
