#pragma once
#include <functional>
#include <optional>
#include <span>
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
  Track track{};
};

/// A length of belt with all that happened to it.
struct SortedStretch {
  std::vector<Tally> cells;
  std::vector<ShownParticle> shown{};
  std::vector<SeenObject> objects{};  ///< where particles are shown
  ValvePulses pulses{};               ///< of each valve, likewise
};

/// How bodies fly over the jets: a tier of the ejection.
struct Ejection {
  /// All at once, in the order of the flyers: they may push each other.
  std::function<std::vector<FlightEnd>(std::span<const Flyer> flyers)> fly;
  std::function<double(const FeedParticle& particle)>
      reach;  ///< m, across, to the axis of a valve it may feel
};
/// The fast tier with the jet of the case.
Ejection fast_ejection(const Case& c, const JetSource& source);

/// The machine: feed -> camera -> controller -> manifold -> flight -> fates. A stretch of belt is a pure
/// function of the case, its place, and the pressure that a vessel has by then: it is computed with halo()
/// cells more at either end, so that what lies there sees all that may blow on it.
class Sorter {
 public:
  Sorter(const Case& c, Ejection ejection);
  /// Cells [first, last); of the first `show` particles everything is kept. `pressure`: of the vessel, Pa, as
  /// the first cell of the halo comes to the valves; it is full by default.
  SortedStretch sort(std::int64_t first, std::int64_t last, int show = 0,
                     std::optional<double> pressure = {}) const;
  /// What the valves do as these cells and their halo pass.
  ValvePulses pulses(std::int64_t first, std::int64_t last) const;
  /// s, at which a cell comes to the valves: the commands that it asks for begin about then.
  double comes_at(std::int64_t cell) const;
  std::int64_t halo() const { return halo_; }

  /// Computes side by side what these cells need of each other's feed: optional, for speed.
  void prepare(std::int64_t first, std::int64_t last) const { feed_.prepare(first - halo_, last + halo_); }

  /// The shots whose objects begin in a cell, each with the particles within its reach, flown by the fast
  /// tier as if no other valve blew.
  std::vector<Shot> shots(std::int64_t cell) const;

  const Feed& feed() const { return feed_; }
  const Camera& camera() const { return camera_; }
  const Manifold& manifold() const { return manifold_; }
  const AirUse& air_use() const { return air_use_; }
  const AirVessel& vessel() const { return vessel_; }

 private:
  struct Scene;
  Fate fate_of(const Scene& scene, std::size_t n, const FlightEnd& flight) const;
  Scene look(std::int64_t first, std::int64_t last) const;
  void add_use(const ValvePulse& pulse, std::int64_t first, std::span<Tally> cells) const;
  Shot shot(const Scene& scene, std::span<const ValveCommand> commands, std::size_t which) const;
  Flyer flyer(const FeedParticle& p, const ValvePulses& pulses, bool as_seen = false) const;
  /// As if no other body were there.
  FlightEnd fly_alone(const FeedParticle& p, const ValvePulses& pulses, bool as_seen = false) const;

  Case case_;
  Feed feed_;
  Camera camera_;
  Controller controller_;
  Manifold manifold_;
  Ejection ejection_;
  AirVessel vessel_;
  AirUse air_use_;
  std::int64_t halo_ = 1;
};

}  // namespace ejecta
