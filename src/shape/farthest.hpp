#pragma once
#include <algorithm>
#include <span>
#include <vector>

#include "base/vec.hpp"

namespace ejecta {

/// Finds the farthest of many points along a direction in a time that grows with the logarithm of their
/// number: boxes of points, halved until few are left.
class Farthest {
 public:
  explicit Farthest(std::span<const Vec3> points) : points_(points.begin(), points.end()) {
    nodes_.push_back({{}, {}, 0, static_cast<int>(points_.size()), 0});
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      const int first = nodes_[n].first, count = nodes_[n].count;
      const auto begin = points_.begin() + first, end = begin + count, half = begin + count / 2;
      Vec3 low = *begin, high = *begin;
      std::for_each(begin, end, [&](const Vec3& p) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
      });
      nodes_[n].middle = 0.5 * (low + high);
      nodes_[n].half = 0.5 * (high - low);
      if (count <= kLeaf) continue;
      int axis = 0;
      (high - low).maxCoeff(&axis);
      std::nth_element(begin, half, end, [&](const Vec3& a, const Vec3& b) { return a[axis] < b[axis]; });
      nodes_[n].child = static_cast<int>(nodes_.size());
      nodes_.push_back({{}, {}, first, count / 2, 0});
      nodes_.push_back({{}, {}, first + count / 2, count - count / 2, 0});
    }
  }

  /// The largest direction . p.
  double along(const Vec3& direction) const {
    double best = -1e300;
    look(0, direction, best);
    return best;
  }

 private:
  static constexpr int kLeaf = 16;
  struct Node {
    Vec3 middle, half;
    int first = 0, count = 0, child = 0;
  };
  double bound(const Node& n, const Vec3& d) const { return d.dot(n.middle) + d.cwiseAbs().dot(n.half); }
  void look(int at, const Vec3& d, double& best) const {
    const Node& n = nodes_[static_cast<std::size_t>(at)];
    if (bound(n, d) <= best) return;
    if (n.child == 0) {
      for (int k = n.first; k < n.first + n.count; ++k)
        best = std::max(best, d.dot(points_[static_cast<std::size_t>(k)]));
      return;
    }
    const bool second = bound(nodes_[static_cast<std::size_t>(n.child + 1)], d) >
                        bound(nodes_[static_cast<std::size_t>(n.child)], d);
    look(n.child + second, d, best);
    look(n.child + !second, d, best);
  }
  std::vector<Vec3> points_;
  std::vector<Node> nodes_;
};

}  // namespace ejecta
