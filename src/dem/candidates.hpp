#pragma once
#include <span>
#include <utility>
#include <vector>

#include "dem/neighbours.hpp"
#include "dem/parts.hpp"
#include "dem/solid_contacts.hpp"

namespace ejecta {

/// Pairs of parts nearer than the skin, sorted: what the narrow phase looks at until something has moved half
/// of it. Pairs of which neither side can be pushed are left out.
struct Candidates {
  const std::vector<std::pair<int, int>>& balls;
  std::vector<SolidPair> solids;
};

class CandidateSearch {
 public:
  Candidates find(const Parts& parts, std::span<const Body> bodies, std::span<const Wall> walls, double skin);

 private:
  NeighbourSearch search_;
  std::vector<NeighbourSearch::Item> items_;
  std::vector<std::pair<int, int>> balls_;
};

}  // namespace ejecta
