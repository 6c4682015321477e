#pragma once
#include <algorithm>
#include <array>
#include <vector>

#include "flow/cut_cells.hpp"

namespace ejecta {

/// How far the nearest solid near by is from the centre of every cell, m; for models that ask.
class SolidDistance {
 public:
  static constexpr Real kNone = Real(1e3);  ///< m: no wall in sight

  explicit SolidDistance(const Grid& grid) : distance_(grid.make_field()) { distance_.fill(kNone); }

  void measure(const CutCells& cut) {
    for (const auto& [i, j, k] : near_) distance_(i, j, k) = kNone;
    near_.clear();
    for (const NearCell& n : cut.near) {
      Real& value = distance_(n.i, n.j, n.k);
      value = std::min(value, std::max(n.distance, Real(1e-9)));
      near_.push_back({n.i, n.j, n.k});
    }
  }
  ConstFieldView view() const { return distance_.view(); }

 private:
  Field distance_;
  std::vector<std::array<int, 3>> near_;  // where it is not far
};

}  // namespace ejecta
