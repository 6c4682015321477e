#pragma once
#include <vector>

#include "case/case.hpp"

namespace ejecta {

/// The [[initial]] regions that hold a point, in their order. Corners of a box may be given in any order.
std::vector<int> regions_at(const Case& c, const Vec3& position);

/// What regions say together, key by key: a later one wins where it says something. Of density and
/// temperature, which follow from one another, the one said last counts.
StateSpec merged(const Case& c, const std::vector<int>& regions);

}  // namespace ejecta
