#pragma once
#include <cmath>
#include <limits>

#include "base/vec.hpp"
#include "case/case.hpp"

namespace ejecta {

/// Where bodies live. One whose centre leaves is taken out, or comes back on the opposite side of a periodic
/// direction.
struct Domain {
  Vec3 low = Vec3::Constant(-std::numeric_limits<double>::infinity()), high = -low;  ///< m
  Vec3 period{0, 0, 0};                                                              ///< m, 0: not periodic

  bool periodic() const { return period.maxCoeff() > 0; }
  /// The whole periods nearest to a distance, m.
  Vec3 whole(const Vec3& d) const {
    Vec3 w(0, 0, 0);
    for (int c = 0; c < 3; ++c)
      if (period[c] > 0) w[c] = period[c] * std::round(d[c] / period[c]);
    return w;
  }
  /// A distance to the nearest image, m.
  Vec3 nearest(const Vec3& d) const { return d - whole(d); }
};

Domain make_domain(const DomainSpec& spec);

}  // namespace ejecta
