#include "dem/rotation.hpp"

#include <algorithm>
#include <cmath>

namespace ejecta {
namespace {

/// An exact turn about one body axis: `l` is the angular momentum in body axes.
void turn_axis(Quat& q, Vec3& l, const Vec3& inertia, int axis, double dt) {
  const double half = 0.5 * dt * l[axis] / inertia[axis];
  const double c = std::cos(half), s = std::sin(half);
  Quat r(c, 0, 0, 0);
  r.vec()[axis] = s;
  q = q * r;
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const double cos2 = c * c - s * s, sin2 = 2 * s * c;
  const double lu = l[u], lv = l[v];
  l[u] = cos2 * lu + sin2 * lv;
  l[v] = cos2 * lv - sin2 * lu;
}

void strang(Quat& q, Vec3& l, const Vec3& inertia, double dt) {
  turn_axis(q, l, inertia, 2, 0.5 * dt);
  turn_axis(q, l, inertia, 1, 0.5 * dt);
  turn_axis(q, l, inertia, 0, dt);
  turn_axis(q, l, inertia, 1, 0.5 * dt);
  turn_axis(q, l, inertia, 2, 0.5 * dt);
}

}  // namespace

void rotate_free(Quat& orientation, const Vec3& momentum, const Vec3& inertia, double dt) {
  Vec3 l = orientation.conjugate() * momentum;
  const double rate = l.cwiseQuotient(inertia).norm();
  if (!(rate > 0)) return;
  static const double outer = 1.0 / (2.0 - std::cbrt(2.0)), inner = 1.0 - 2.0 * outer;
  const int pieces = std::max(1, static_cast<int>(std::ceil(rate * dt / kLargestTurn)));
  const double h = dt / pieces;
  for (int n = 0; n < pieces; ++n) {
    strang(orientation, l, inertia, outer * h);
    strang(orientation, l, inertia, inner * h);
    strang(orientation, l, inertia, outer * h);
  }
  orientation.normalize();
}

void turn(Quat& orientation, const Vec3& rotation) {
  const double angle = rotation.norm();
  if (angle > 0) orientation = (Quat(Eigen::AngleAxisd(angle, rotation / angle)) * orientation).normalized();
}

}  // namespace ejecta
