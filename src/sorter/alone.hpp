#pragma once
#include <span>
#include <vector>

#include "sorter/feed_particle.hpp"

namespace ejecta {

/// Which particles have no other within `gap` (m) of their outline.
std::vector<bool> standing_alone(std::span<const FeedParticle> particles, double gap);

}  // namespace ejecta
