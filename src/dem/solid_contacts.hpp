#pragma once
#include <array>
#include <compare>
#include <span>
#include <tuple>
#include <vector>

#include "base/state_reader.hpp"
#include "dem/domain.hpp"
#include "dem/materials.hpp"
#include "dem/parts.hpp"
#include "dem/walls.hpp"

namespace ejecta {

enum class PartKind : int { ball, polytope, wall_plane, wall_solid, wall_region, wall_triangle };

/// One side of a contact: a ball or polytope (index into Parts) or a wall (index), with its solid, region or
/// triangle, and which of its images across periodic sides.
struct PartKey {
  PartKind kind = PartKind::ball;
  int index = 0, solid = 0, image = 0;
  auto operator<=>(const PartKey&) const = default;
};

/// What the narrow phase returns; world axes.
struct Touch {
  Vec3 normal{0, 0, 1};       ///< from b to a
  double overlap = 0.0;       ///< m, 0: apart
  double radius = 0.0;        ///< m, effective
  Vec3 point{0, 0, 0};        ///< m
  double patch_radius = 0.0;  ///< m, of a flat contact (0: a point)
  double size = 0.0;          ///< m, of the parts: scale of rolling resistance
  double depth = 0.0;         ///< m, of a flat contact: elastic energy over spring force; 0: not known
  double thickness = 0.0;     ///< m, mean, of a flat contact
  Vec3 lean{0, 0, 0};  ///< m2, of a flat contact: by how much its pressure's centre lies beside the patch's,
                       ///< times thickness
  int side = 0;        ///< of a surface on which a is: 1, -1
  int face = -1;       ///< of a polytope before which a ball is
  bool on_face = false;  ///< of a triangle: the ball stands on its inside, not on its rim
  bool ghost = false;    ///< a meets a side that does not touch
  Vec3 apart{0, 0, 0};   ///< two polytopes stood apart along this when last looked at, axes of a's body
};

/// What changes in time along a contact.
struct ContactHistory {
  Triple<double> slip, roll;  ///< m, rad
  Twist twist;
  Triple<double> normal;    ///< at the last step; zero: they did not touch
  Triple<double> lean;      ///< m2, at the last step, as in Touch
  int side = 0, face = -1;  ///< as in Touch
  double energy = 0.0;  ///< J, that all contacts of the two bodies have stored: work done on their springs
  double power = 0.0;   ///< W, the rate of that at the last step
  double dent = 1.0;    ///< of the overlap, what that energy suffices for
  bool operator==(const ContactHistory&) const = default;
  bool touched() const { return dot(normal, normal) > 0; }
};

/// A contact in which a polytope or a wall takes part.
struct SolidPair {
  PartKey a, b;
  int body_a = 0, body_b = -1;  ///< -1: a wall
  Vec3 shift{0, 0, 0};          ///< m, from b to the image of it that a meets across a periodic side
  ContactHistory history;
  Touch touch;
  bool hidden = false;  ///< another contact of the same surface stands for it
  /// A ball that was listed here was so far away, m; until it has come as far there is nothing to look at.
  Vec3 listed_at{0, 0, 0};
  double gap = 0.0;
  bool away = false;        ///< it has not, and nothing is remembered
  double stored = 0.0;      ///< J, in the normal spring
  Vec3 force{0, 0, 0};      ///< N, on a
  Vec3 moment{0, 0, 0};     ///< N m, on a besides the force's: rolling and twisting
  double elastic = 0.0;     ///< J
  double wall_power = 0.0;  ///< W, done by the moving wall on the body
};

/// The order in which contacts are kept.
inline bool is_before(const SolidPair& p, const SolidPair& q) {
  return std::tie(p.a, p.b) < std::tie(q.a, q.b);
}

/// Which of a wall's images a body meets: the periods (-1, 0, 1 along x, y, z) by which the body was moved to
/// it, as one number. 0: the wall itself.
int image_of(const Eigen::Vector3i& periods);
/// That number once the body itself has gone through `crossed` periods.
int image_after(int image, const Eigen::Vector3i& crossed);

class SolidContacts {
 public:
  /// Candidates, sorted by (a, b), in exchange for the old ones; histories of pairs that were there before
  /// are kept but for those of bodies (by index) that were put where they are since.
  void set_pairs(std::vector<SolidPair>& pairs, std::span<const char> fresh);
  /// `velocity`, `spin`: of the bodies, m/s and rad/s.
  void compute(const Parts& parts, std::span<const Body> bodies, std::span<const Wall> walls,
               const Materials& materials, const Domain& domain, std::span<const Vec3> velocity,
               std::span<const Vec3> spin, double dt);
  /// add(body, force, moment, point, touch): each contact's force and moment on each of its bodies, at the
  /// point where that body is, in order.
  template <class Add>
  void gather(const Add& add) const {
    for (const SolidPair& p : pairs_) {
      if (!(p.touch.overlap > 0)) continue;
      add(p.body_a, p.force, p.moment, p.touch.point, p.touch);
      if (p.body_b >= 0)
        add(p.body_b, Vec3(-p.force), Vec3(-p.moment), Vec3(p.touch.point - p.shift), p.touch);
    }
  }

  /// A ball's friction with a wall (slip and roll, x, y, z each) and what their contact has stored (J), from
  /// where it was a plane to the ball, goes to the triangles that it meets now.
  void hand_over(int ball, int wall, const Vec3& normal, const std::array<double, 6>& friction,
                 double energy);

  std::span<const SolidPair> pairs() const { return pairs_; }
  double elastic() const;
  double wall_power() const;
  double asked_rate() const { return asked_rate_; }  ///< sub-steps a second, by the last compute()
  void save(std::vector<double>& out) const;
  void load(StateReader& in, int bodies);
  /// For bodies that came back on the other side of a periodic direction, `periods(body)` is how many they
  /// went along x, y, z (0: none): the images of the walls that they touch go with them.
  template <class Periods>
  void follow(const Periods& periods) {
    for (SolidPair& p : pairs_)
      if (p.body_b < 0 && p.b.kind != PartKind::wall_plane)
        p.b.image = image_after(p.b.image, periods(p.body_a));
    sort();
  }
  /// Keeps only pairs for which `rename` returns true after changing them.
  template <class Rename>
  void rename(const Rename& rename) {
    std::erase_if(pairs_, [&](SolidPair& p) { return !rename(p); });
    arrange();
  }

 private:
  struct World;
  void sort();
  void arrange();
  void choose(const World& world, int begin, int end);
  /// Returns what these contacts ask of the time step, asked_rate_squared.
  double apply_laws(const World& world, int begin, int end, double dt);

  std::vector<SolidPair> pairs_;
  std::vector<int> runs_;  // where those of a ball with one body or wall begin and end, in turn
  double asked_rate_ = 0.0;
  std::vector<double> asked_;       // squares of it, of each two bodies
  std::vector<int> order_, first_;  // pairs by the two bodies (all walls are one), and where each two begin
};

/// How two parts touch by themselves, whatever else the bodies they belong to touch.
Touch find_touch(const SolidPair& pair, const Parts& parts, std::span<const Body> bodies,
                 std::span<const Wall> walls, const Domain& domain);
/// How far b, of which a pair tells, lies from a point, m.
double distance_to(const SolidPair& pair, const Vec3& point, const Parts& parts, std::span<const Body> bodies,
                   std::span<const Wall> walls);

}  // namespace ejecta
