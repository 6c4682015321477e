#pragma once
#include <array>
#include <compare>
#include <span>
#include <vector>

#include "base/state_reader.hpp"
#include "dem/materials.hpp"
#include "dem/parts.hpp"
#include "dem/walls.hpp"

namespace ejecta {

enum class PartKind : int { ball, polytope, wall_plane, wall_solid };

/// One side of a contact: a ball or polytope (index into Parts) or a wall (index), with its solid.
struct PartKey {
  PartKind kind = PartKind::ball;
  int index = 0, solid = 0;
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
  double depth = 0.0;         ///< m, elastic energy over spring force; 0: as the law says
  double thickness = 0.0;     ///< m, mean, of a flat contact
};

/// What changes in time along a contact.
struct ContactHistory {
  Triple<double> slip, roll;  ///< m, rad
  double twist = 0.0;         ///< rad
  bool operator==(const ContactHistory&) const = default;
};

/// A contact in which a polytope or a wall takes part.
struct SolidPair {
  PartKey a, b;
  int body_a = 0, body_b = -1;  ///< -1: a wall
  Vec3 shift{0, 0, 0};          ///< m, from b to the image of it that a meets across a periodic side
  ContactHistory history;
  Touch touch;
  Vec3 force{0, 0, 0};      ///< N, on a
  Vec3 moment{0, 0, 0};     ///< N m, on a besides the force's: rolling and twisting
  double elastic = 0.0;     ///< J
  double wall_power = 0.0;  ///< W, done by the moving wall on the body
};

class SolidContacts {
 public:
  /// Candidates, sorted by (a, b), in exchange for the old ones; histories of pairs that were there before
  /// are kept.
  void set_pairs(std::vector<SolidPair>& pairs);
  /// `velocity`, `spin`: of the bodies, m/s and rad/s.
  void compute(const Parts& parts, std::span<const Body> bodies, std::span<const Wall> walls,
               const Materials& materials, std::span<const Vec3> velocity, std::span<const Vec3> spin,
               double dt);
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

  std::span<const SolidPair> pairs() const { return pairs_; }
  double elastic() const;
  double wall_power() const;
  void save(std::vector<double>& out) const;
  void load(StateReader& in, int bodies);
  /// Keeps only pairs for which `rename` returns true after changing them.
  template <class Rename>
  void rename(const Rename& rename) {
    std::erase_if(pairs_, [&](SolidPair& p) { return !rename(p); });
  }

 private:
  std::vector<SolidPair> pairs_;
};

/// How two parts touch.
Touch find_touch(const SolidPair& pair, const Parts& parts, std::span<const Body> bodies,
                 std::span<const Wall> walls);

}  // namespace ejecta
