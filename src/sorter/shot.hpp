#pragma once
#include <vector>

#include "sorter/feed_particle.hpp"
#include "sorter/tally.hpp"

namespace ejecta {

/// A particle as a shot finds it.
struct ShotBody {
  FeedParticle particle;
  double at = 0.0;       ///< s, after the command, when its centre is over the jets if no air blows
  double y = 0.0;        ///< m, from the middle of the valves that blow
  bool counts = false;   ///< it is this shot's, and no other's
  bool ejected = false;  ///< by the fast tier, by this shot alone
  double gain = 0.0;     ///< m/s, of vertical velocity, likewise
};

/// The seam between the tiers: the bodies within reach of some valves, and their command. Plain data.
struct Shot {
  std::vector<ShotBody> bodies;
  std::vector<double> valves;  ///< m, across, from their middle
  double lasts = 0.0;          ///< s
};

}  // namespace ejecta
