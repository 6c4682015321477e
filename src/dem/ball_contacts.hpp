#pragma once
#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "dem/materials.hpp"
#include "dem/parts.hpp"
#include "dem/sphere_state.hpp"

namespace ejecta {

/// Contacts between balls: spheres and the spheres of multi-sphere bodies. Eight pairs at a time.
class BallContacts {
 public:
  /// What a pair (a, b) does: one cache line.
  struct alignas(64) PairRow {
    double fx = 0, fy = 0, fz = 0;  ///< N, on a
    double half_overlap = 0;        ///< m, 0: apart
    double gx = 0, gy = 0, gz = 0;  ///< N, normal (from b to a) x force
    double elastic = 0;             ///< J
  };

  /// Candidate pairs of balls (a < b), sorted. Histories of pairs that were there before are kept.
  void set_pairs(const std::vector<std::pair<int, int>>& pairs, int balls);
  /// Evaluates the law on every pair and moves the histories over dt.
  void compute(const Parts& parts, const Materials& materials, double dt);
  /// Adds the force and the torque about the ball's centre that act on it. Returns its largest half overlap,
  /// m.
  double gather(int ball, double radius, Vec4& force, Vec4& torque) const;

  double elastic() const;  ///< J

  int pair_count() const { return count_; }
  std::pair<int, int> pair(int n) const { return {a_[at(n)], b_[at(n)]}; }
  const PairRow& row(int n) const { return rows_[at(n)]; }

  /// Gives balls their new indices (-1: gone, with its pairs).
  void rename(std::span<const int> names, int balls);
  /// a, b and history of each pair that has one.
  void save(std::vector<double>& out) const;
  const double* load(const double* in, int balls);

 private:
  static std::size_t at(int n) { return static_cast<std::size_t>(n); }
  void index_pairs(int balls);
  template <class Law, bool Rolling>
  void compute_all(const Parts& parts, const Materials& materials, double dt);

  int count_ = 0;                   // without the padding to whole lanes
  std::vector<int> a_, b_;          // padded with the ball that touches nothing
  std::vector<double> history_[6];  // slip x, y, z and roll x, y, z of each pair
  std::vector<PairRow> rows_;
  std::vector<double> moments_[3];  // N m, rolling resistance on a
  std::vector<int> cursor_;
  std::vector<int> first_, entries_;  // of each ball: 2 n for pair n as a, 2 n + 1 as b, in order
  bool rolling_ = false;
};

inline double BallContacts::gather(int ball, double radius, Vec4& force, Vec4& torque) const {
  double deepest = 0.0;
  Vec4 f{}, t{};  // in registers: the rows might alias what the arguments refer to
  for (int k = first_[at(ball)]; k < first_[at(ball) + 1]; ++k) {
    const int entry = entries_[at(k)];
    const double sign = 1 - 2 * (entry & 1);
    const PairRow& row = rows_[at(entry >> 1)];
    const Vec4 push = *reinterpret_cast<const LooseVec4*>(&row.fx);
    const Vec4 turning = *reinterpret_cast<const LooseVec4*>(&row.gx);
    f += sign * push;
    deepest = std::max(deepest, row.half_overlap);
    t -= (radius - row.half_overlap) * turning;
    if (rolling_) {
      const std::size_t n = at(entry >> 1);
      t += sign * Vec4{moments_[0][n], moments_[1][n], moments_[2][n], 0.0};
    }
  }
  f[3] = t[3] = 0.0;
  force += f;
  torque += t;
  return deepest;
}

}  // namespace ejecta
