#pragma once
#include <span>
#include <vector>

#include "dem/body.hpp"

namespace ejecta {

/// A ball of a body in the world: all that a contact of balls reads, in three registers.
struct alignas(32) BallRow {
  double x = 0, y = 0, z = 0, radius = 0;           // m
  double vx = 0, vy = 0, vz = 0, inverse_mass = 0;  // m/s of its centre; 1/kg of its body (0: immovable)
  double wx = 0, wy = 0, wz = 0, material = 0;      // rad/s

  Vec3 centre() const { return {x, y, z}; }
  Vec3 velocity() const { return {vx, vy, vz}; }
  Vec3 spin() const { return {wx, wy, wz}; }
};

/// A polytope of a body.
struct PolytopePart {
  int body = 0;
  const Polytope* solid = nullptr;  ///< body axes
  double radius = 0.0;              ///< m, of the ball of the body's volume: the scale of its contacts
};

/// The balls and polytopes of all bodies, body after body.
class Parts {
 public:
  void add(const Body& body, int index);
  void clear();

  /// Writes the rows of a body from its place and the given velocities.
  void update(int index, const Body& body, const Vec3& velocity, const Vec3& spin);

  int ball_count() const { return static_cast<int>(ball_body_.size()); }
  int polytope_count() const { return static_cast<int>(polytopes_.size()); }
  /// One row more than balls: the last one never touches anything.
  std::span<const BallRow> rows() const { return rows_; }
  const BallRow& row(int ball) const { return rows_[static_cast<std::size_t>(ball)]; }
  int ball_count(int body) const { return first_ball(body + 1) - first_ball(body); }
  bool any_of_several_balls() const { return several_; }
  int body_of_ball(int ball) const { return ball_body_[static_cast<std::size_t>(ball)]; }
  const PolytopePart& polytope(int n) const { return polytopes_[static_cast<std::size_t>(n)]; }
  /// Balls of a body: [first_ball(body), first_ball(body + 1)).
  int first_ball(int body) const { return first_ball_[static_cast<std::size_t>(body)]; }
  int first_polytope(int body) const { return first_polytope_[static_cast<std::size_t>(body)]; }
  /// Whether a body is there: one that has not come yet or has gone meets nobody.
  bool here(int body) const { return here_[static_cast<std::size_t>(body)]; }
  void set_here(int body, bool here) { here_[static_cast<std::size_t>(body)] = here; }
  /// One ball in the centre of mass and nothing else.
  bool is_sphere(int body) const {
    return first_ball(body + 1) - first_ball(body) == 1 && first_polytope(body + 1) == first_polytope(body);
  }
  BallRow& sphere_row(int body) { return rows_[static_cast<std::size_t>(first_ball(body))]; }
  /// Farthest that the centre of a part lies from the body's, m.
  double arm(int body) const { return arm_[static_cast<std::size_t>(body)]; }

 private:
  std::vector<BallRow> rows_{BallRow{}};
  std::vector<Vec3> local_;
  std::vector<int> ball_body_;
  std::vector<PolytopePart> polytopes_;
  std::vector<double> arm_;
  std::vector<char> here_;
  std::vector<int> first_ball_{0}, first_polytope_{0};
  bool several_ = false;
};

/// 1/mass as contacts see it: fixed and prescribed bodies cannot be pushed.
inline double inverse_mass(const Body& body) { return body.motion == Motion::free ? 1.0 / body.mass : 0.0; }

}  // namespace ejecta
