#pragma once
#include <array>

#include "case/case.hpp"

namespace ejecta {

/// Rows and columns of a grid whose steps are counted from the jet's axis, as far as they lie in a window.
struct MapGrid {
  int first_x = 0, last_x = 0, first_y = 0, last_y = 0;

  /// At least three rows and columns; of a half, whose lowest row is the axis, two rows.
  bool is_plane(bool half) const { return last_x >= first_x + 2 && last_y >= first_y + (half ? 1 : 2); }
  double places() const { return (last_x - first_x + 1.0) * (last_y - first_y + 1.0); }
};

/// Of the windows [low, high] along and across, m, and these steps, m.
MapGrid map_grid(const std::array<double, 2>& along, const std::array<double, 2>& across,
                 const std::array<double, 2>& steps);

}  // namespace ejecta
