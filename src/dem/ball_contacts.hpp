#pragma once
#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "base/state_reader.hpp"
#include "dem/domain.hpp"
#include "dem/materials.hpp"
#include "dem/parts.hpp"
#include "dem/sphere_state.hpp"
#include "dem/walls.hpp"

namespace ejecta {

/// Contacts of balls (spheres and the spheres of multi-sphere bodies) with each other and with planes. Eight
/// pairs at a time.
class BallContacts {
 public:
  /// What a pair (a, b) does: one cache line.
  struct alignas(64) PairRow {
    double fx = 0, fy = 0, fz = 0;  ///< N, on a
    double half_overlap = 0;        ///< m, 0: apart
    double gx = 0, gy = 0, gz = 0;  ///< N, normal (from b to a) x force
    double elastic = 0;             ///< J
  };

  /// Candidate pairs, sorted: balls (a < b), and balls with walls that are planes. Histories of pairs that
  /// were there before are kept.
  using Pairs = std::span<const std::pair<int, int>>;
  void set_pairs(Pairs balls, Pairs planes, const Parts& parts);
  /// Bodies (by index) that were put where they are during the last dt. What overlapped there is no dent: no
  /// work was done on it. Its contacts begin from that overlap, as long as it lasts.
  void note_births(std::span<const char> fresh, const Parts& parts, const Domain& domain, double dt);
  void add(const WallPlane& plane, const Wall& wall);
  /// Evaluates the law on every pair and moves the histories over dt.
  void compute(const Parts& parts, const Materials& materials, const Domain& domain, double dt);
  /// Adds the force and the torque about the ball's centre that act on it. Returns its largest half overlap,
  /// m.
  double gather(int ball, double radius, Vec4& force, Vec4& torque) const;

  /// The pair of a ball with a plane, if it touched at the last step; else -1.
  int touching(int ball, int plane) const;
  /// The pair of a ball with one of the planes [from, to), or -1.
  int find_plane(int ball, int from, int to) const;
  /// Slip (m) and roll (rad) of a pair: x, y, z each.
  std::array<double, 6> friction(int n) const;
  void set_friction(int n, const std::array<double, 6>& h);
  /// Of a pair that touches, J, what its contact may give back at most. A dent that is whole stores what the
  /// law says, whatever moves in the meantime: more than enough.
  double energy(int n) const { return (history_[kBirth][at(n)] > 0 ? 1.0 : 2.0) * rows_[at(n)].elastic; }
  /// Lets a pair have only the share `part` of the dent that it seems to have.
  void set_dent(int n, double part, const Parts& parts, const Domain& domain);

  double elastic() const;     ///< J
  double wall_power() const;  ///< W, done by the moving planes on the balls

  int pair_count() const { return static_cast<int>(a_.size()); }  ///< with those that pad the lanes
  /// Ball a; ball b, or -1 - n for plane n.
  std::pair<int, int> pair(int n) const { return {a_[at(n)], n < planes_from_ ? b_[at(n)] : -1 - b_[at(n)]}; }
  const PairRow& row(int n) const { return rows_[at(n)]; }

  /// Gives balls their new indices (-1: gone, with its pairs).
  void rename(std::span<const int> names, int balls);
  /// Both sides of each pair, what it remembers and what it did at the last step.
  void save(std::vector<double>& out) const;
  void load(StateReader& in, const Parts& parts);

 private:
  static std::size_t at(int n) { return static_cast<std::size_t>(n); }
  void arrange(Pairs balls, Pairs planes, int ball_count);
  void find_births();
  /// How far a pair overlaps, m, and how fast it nears, m/s.
  struct Nearing {
    Vec3 normal{0, 0, 1};
    double overlap = 0.0, speed = 0.0;
  };
  Nearing nearing(int n, const Parts& parts, const Domain& domain) const;
  void index_pairs(int balls);
  void group_pairs(const Parts& parts);
  void share_energy(const Parts& parts, const Materials& materials, const Domain& domain);
  static BallRow untouched();
  template <class Law, bool Rolling>
  void compute_all(const Parts& parts, const Materials& materials, const Domain& domain, double dt);
  template <class Law, bool Rolling, bool Planes>
  void compute_groups(const Parts& parts, const Materials& materials, const Domain& domain, double dt);

  // Pairs of balls, padded to whole lanes with the ball that touches nothing; then those with planes, with
  // the wall as b, padded likewise.
  std::vector<int> a_, b_;
  int planes_from_ = 0;
  std::vector<BallRow> planes_{1,
                               untouched()};  // normal, offset, velocity, material; the last touches nothing
  static constexpr std::size_t kBirth = 6, kRemembered = 7;
  // Of each pair slip x, y, z, roll x, y, z and the overlap with which it was born, m.
  std::vector<double> history_[kRemembered];
  std::vector<double> shares_;        // of the energy that all contacts of the two bodies store
  std::vector<int> last_a_, last_b_;  // before the pairs were set anew
  std::vector<double> last_history_[kRemembered];
  std::vector<PairRow> rows_;
  std::vector<double> moments_[3];  // N m, rolling resistance on a
  std::vector<int> cursor_;
  std::vector<int> first_, entries_;   // of each ball: 2 n for pair n as a, 2 n + 1 as b, in order
  std::vector<int> grouped_, groups_;  // pairs by the two bodies (all walls are one); where each group begins
  bool rolling_ = false, births_ = false;
};

inline double BallContacts::gather(int ball, double radius, Vec4& force, Vec4& torque) const {
  constexpr Vec4 signs[2] = {{1, 1, 1, 0}, {-1, -1, -1, 0}};
  double deepest = 0.0;
  Vec4 f{}, t{};  // in registers: the rows might alias what the arguments refer to
  const int from = first_[at(ball)], to = first_[at(ball) + 1];
  for (int k = from; k < to; ++k) {
    const int entry = entries_[at(k)];
    const PairRow& row = rows_[at(entry >> 1)];
    f += signs[entry & 1] * *reinterpret_cast<const LooseVec4*>(&row.fx);
    t -= (radius - row.half_overlap) * *reinterpret_cast<const LooseVec4*>(&row.gx);
    deepest = std::max(deepest, row.half_overlap);
  }
  if (rolling_)
    for (int k = from; k < to; ++k) {
      const std::size_t n = at(entries_[at(k)] >> 1);
      t += signs[entries_[at(k)] & 1] * Vec4{moments_[0][n], moments_[1][n], moments_[2][n], 0.0};
    }
  t[3] = 0.0;
  force += f;
  torque += t;
  return deepest;
}

}  // namespace ejecta
