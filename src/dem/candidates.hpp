#pragma once
#include <span>
#include <utility>
#include <vector>

#include "dem/neighbours.hpp"
#include "dem/parts.hpp"
#include "dem/solid_contacts.hpp"

namespace ejecta {

/// Pairs of parts nearer than the skin, sorted: what the narrow phase looks at until something has moved half
/// of it. Pairs of which neither side can be pushed are left out. Keeps its buffers.
class CandidateSearch {
 public:
  void find(const Parts& parts, std::span<const Body> bodies, std::span<const Wall> walls, double skin);
  std::span<const std::pair<int, int>> balls() const { return balls_; }    ///< indices of balls
  std::span<const std::pair<int, int>> planes() const { return planes_; }  ///< ball, wall that is a plane
  std::vector<SolidPair>& solids() { return solids_; }

 private:
  NeighbourSearch search_;
  std::vector<NeighbourSearch::Item> items_;
  std::vector<char> can_be_pushed_;  // of items
  std::vector<std::pair<int, int>> balls_, planes_;
  std::vector<SolidPair> solids_;
};

}  // namespace ejecta
