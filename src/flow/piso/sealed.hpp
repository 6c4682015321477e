#pragma once
#include <array>
#include <optional>

#include "flow/boundary.hpp"
#include "flow/cut_cells.hpp"
#include "grid/grid.hpp"

namespace ejecta {

/// Fluid that boundaries push into a part of the box, or pull out of it, that solids close off from every
/// open face: no pressure can balance it.
struct Sealed {
  double flow;  ///< m3/s, net, into the part
  Vec3 at;      ///< a face through which it goes, m
};

/// The part of the box with the most of it; none where every part has an open face or nothing to balance.
/// q: face velocities with those of the boundaries.
std::optional<Sealed> find_sealed(const Grid& grid, const CutCells& cut, const Boundaries& boundaries,
                                  const std::array<ConstFieldView, 3>& q);

}  // namespace ejecta
