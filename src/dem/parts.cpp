#include "dem/parts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "shape/polytope.hpp"

namespace ejecta {

void Parts::add(const Body& body, int index) {
  rows_.pop_back();
  double arm = 0.0;
  for (const Ball& ball : body.shape.balls()) {
    BallRow row;
    row.radius = ball.radius;
    row.inverse_mass = inverse_mass(body);
    row.material = body.material;
    rows_.push_back(row);
    local_.push_back(ball.centre);
    arm = std::max(arm, ball.centre.norm());
    ball_body_.push_back(index);
  }
  rows_.push_back(BallRow{});
  const double radius = std::cbrt(0.75 / std::numbers::pi * body.shape.mass_properties().volume);
  for (const Polytope& p : body.shape.polytopes()) {
    polytopes_.push_back({index, &p, radius});
    arm = std::max(arm, p.centre.norm());
  }
  several_ = several_ || body.shape.balls().size() > 1;
  arm_.push_back(arm);
  here_.push_back(true);
  first_ball_.push_back(ball_count());
  first_polytope_.push_back(polytope_count());
  update(index, body, body.velocity, body.angular_velocity);
}

void Parts::clear() { *this = Parts(); }

void Parts::update(int index, const Body& body, const Vec3& velocity, const Vec3& spin) {
  const int first = first_ball(index), end = first_ball(index + 1);
  const bool centred = end - first == 1;  // a sphere: its ball lies in the centre of mass
  for (int n = first; n < end; ++n) {
    BallRow& row = rows_[static_cast<std::size_t>(n)];
    const Vec3 arm = centred ? Vec3(0, 0, 0) : Vec3(body.orientation * local_[static_cast<std::size_t>(n)]);
    const Vec3 v = centred ? velocity : Vec3(velocity + spin.cross(arm));
    row.x = body.position.x() + arm.x();
    row.y = body.position.y() + arm.y();
    row.z = body.position.z() + arm.z();
    row.vx = v.x();
    row.vy = v.y();
    row.vz = v.z();
    row.wx = spin.x();
    row.wy = spin.y();
    row.wz = spin.z();
  }
}

}  // namespace ejecta
