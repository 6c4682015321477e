#pragma once
#include <algorithm>

#include "grid/grid.hpp"

namespace ejecta {

/// Trilinear interpolation between cell centres; positions outside are moved to the nearest centre.
class GridSampler {
 public:
  GridSampler(const Grid& grid, const Vec3& position) {
    for (int d = 0; d < 3; ++d) {
      const Axis& a = grid.axis(d);
      if (a.n == 1) continue;
      int cell = a.cell_at(position[d]);
      if (position[d] < a.centre[static_cast<std::size_t>(cell)]) --cell;
      cell = std::clamp(cell, 0, a.n - 2);
      const double low = a.centre[static_cast<std::size_t>(cell)],
                   high = a.centre[static_cast<std::size_t>(cell) + 1];
      lower_[d] = cell;
      share_[d] = std::clamp((position[d] - low) / (high - low), 0.0, 1.0);
    }
  }

  double operator()(ConstFieldView f) const {
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
      double weight = 1.0;
      int at[3];
      for (int d = 0; d < 3; ++d) {
        const int up = corner >> d & 1;
        weight *= up ? share_[d] : 1.0 - share_[d];
        at[d] = lower_[d] + (share_[d] > 0.0 ? up : 0);
      }
      if (weight > 0.0) sum += weight * double(f(at[0], at[1], at[2]));
    }
    return sum;
  }

 private:
  int lower_[3] = {0, 0, 0};
  double share_[3] = {0, 0, 0};
};

}  // namespace ejecta
