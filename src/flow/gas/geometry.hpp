#pragma once
#include <array>
#include <vector>

#include "grid/grid.hpp"

namespace ejecta::gas {

/// Lengths along one axis that the kernels need besides the grid's Metrics, indexable from -kGhosts to n +
/// kGhosts.
struct AxisLengths {
  Metrics metrics{};
  const Real* inv_span = nullptr;           ///< 1 / (centre i+1 - centre i-1), 1/m
  const Real* inv_radius_centre = nullptr;  ///< 1/r at the centre of a cell; 0 in Cartesian geometry
  const Real* inv_radius_face = nullptr;  ///< 1/r at its lower face; 0 on the axis and in Cartesian geometry
  const Real* inv_width = nullptr;        ///< 1/m; 0 along an axis that carries no flux
  const Real* hoop =
      nullptr;  ///< (area i+1 - area i)/volume: balances even pressure; 0 in Cartesian geometry
};

/// The AxisLengths of all three axes and their storage.
class Geometry {
 public:
  explicit Geometry(const Grid& grid);
  const AxisLengths& axis(int d) const { return axis_[static_cast<std::size_t>(d)]; }

 private:
  std::array<AxisLengths, 3> axis_;
  std::array<std::vector<Real>, 15> storage_;
};

}  // namespace ejecta::gas
