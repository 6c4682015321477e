#include "flow/gas/geometry.hpp"

#include <cmath>

#include "base/simd.hpp"

namespace ejecta::gas {

Geometry::Geometry(const Grid& grid) {
  for (int d = 0; d < 3; ++d) {
    const Metrics m = grid.metrics(d);
    const bool radial = grid.axisymmetric() && d == 0;
    // Kernels run over whole registers (for_each_lane)
    const auto total = static_cast<std::size_t>(grid.n(d) + 2 * kGhosts + 1 + kRealLanes);
    std::array<std::vector<Real>*, 5> line{};
    for (std::size_t q = 0; q < 5; ++q) {
      line[q] = &storage_[5 * static_cast<std::size_t>(d) + q];
      line[q]->assign(total, Real(0));
    }
    for (int i = -kGhosts; i < grid.n(d) + kGhosts; ++i) {
      const auto n = static_cast<std::size_t>(i + kGhosts);
      if (i > -kGhosts) (*line[0])[n] = 1 / (m.centre[i + 1] - m.centre[i - 1]);
      if (grid.active(d)) (*line[3])[n] = 1 / m.width[i];
      if (!radial) continue;
      (*line[1])[n] = 1 / std::abs(m.centre[i]);
      (*line[2])[n] = m.area[i] > 0 ? 1 / m.area[i] : Real(0);
      (*line[4])[n] = (m.area[i + 1] - m.area[i]) * m.inv_volume[i];
    }
    axis_[static_cast<std::size_t>(d)] = {m,
                                          line[0]->data() + kGhosts,
                                          line[1]->data() + kGhosts,
                                          line[2]->data() + kGhosts,
                                          line[3]->data() + kGhosts,
                                          line[4]->data() + kGhosts};
  }
}

}  // namespace ejecta::gas
