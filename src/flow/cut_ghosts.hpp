#pragma once
#include <vector>

#include "flow/cut_cells.hpp"

namespace ejecta {

/// What the donors of a ghost say of a field.
inline Real from_donors(const GhostCell& g, ConstFieldView f) {
  const Real* here = &f(g.i, g.j, g.k);
  Real sum = 0;
  for (std::size_t m = 0; m < static_cast<std::size_t>(g.donors); ++m) sum += g.weight[m] * here[g.donor[m]];
  return sum;
}

/// Ghosts, those that `which` chooses, take a scalar from their donors: no gradient at the wall. `scratch` is
/// kept between calls.
template <class Which>
void extend_to_ghosts(const CutCells& cut, FieldView f, std::vector<Real>& scratch, const Which& which) {
  scratch.resize(cut.ghosts.size());
  for_each_index(static_cast<int>(cut.ghosts.size()), [&](int n) {
    const GhostCell& g = cut.ghosts[static_cast<std::size_t>(n)];
    scratch[static_cast<std::size_t>(n)] = g.donors > 0 && which(g) ? from_donors(g, f) : f(g.i, g.j, g.k);
  });
  for_each_index(static_cast<int>(cut.ghosts.size()), [&](int n) {
    const GhostCell& g = cut.ghosts[static_cast<std::size_t>(n)];
    f(g.i, g.j, g.k) = scratch[static_cast<std::size_t>(n)];
  });
}
inline void extend_to_ghosts(const CutCells& cut, FieldView f, std::vector<Real>& scratch) {
  extend_to_ghosts(cut, f, scratch, [](const GhostCell&) { return true; });
}

}  // namespace ejecta
