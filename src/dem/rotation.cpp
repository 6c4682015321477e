#include "dem/rotation.hpp"

#include <algorithm>
#include <cmath>

namespace ejecta {
namespace {

struct CosSin {
  double cosine, sine;
};

/// Of the small angles that turns are made of: their series, to the last bit or two. Libm takes ten times as
/// long.
CosSin cos_sin(double x) {
  constexpr double kSmall = 0.07;  // rad: the first term left out is 1e-18 of the sum
  if (!(std::abs(x) < kSmall)) return {std::cos(x), std::sin(x)};
  const double y = x * x;
  return {1 - y * (1.0 / 2 - y * (1.0 / 24 - y * (1.0 / 720 - y * (1.0 / 40320 - y * (1.0 / 3628800))))),
          x * (1 - y * (1.0 / 6 - y * (1.0 / 120 - y * (1.0 / 5040 - y * (1.0 / 362880)))))};
}

/// An exact turn about one body axis: `l` is the angular momentum in body axes.
template <int axis>
void turn_axis(Quat& q, Vec3& l, const Vec3& inertia, double dt) {
  const double half = 0.5 * dt * l[axis] / inertia[axis];
  const auto [c, s] = cos_sin(half);
  constexpr int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const double w = q.w(), a = q.vec()[axis], b = q.vec()[u], d = q.vec()[v];  // q (c + s e_axis)
  q.w() = c * w - s * a;
  q.vec()[axis] = c * a + s * w;
  q.vec()[u] = c * b + s * d;
  q.vec()[v] = c * d - s * b;
  const double cos2 = c * c - s * s, sin2 = 2 * s * c;
  const double lu = l[u], lv = l[v];
  l[u] = cos2 * lu + sin2 * lv;
  l[v] = cos2 * lv - sin2 * lu;
}

void strang(Quat& q, Vec3& l, const Vec3& inertia, double dt) {
  turn_axis<2>(q, l, inertia, 0.5 * dt);
  turn_axis<1>(q, l, inertia, 0.5 * dt);
  turn_axis<0>(q, l, inertia, dt);
  turn_axis<1>(q, l, inertia, 0.5 * dt);
  turn_axis<2>(q, l, inertia, 0.5 * dt);
}

}  // namespace

void rotate_free(Quat& orientation, const Vec3& momentum, const Vec3& inertia, double dt) {
  Vec3 l = orientation.conjugate() * momentum;
  Quat q = orientation;  // a copy stays in registers
  const double rate = l.cwiseQuotient(inertia).norm();
  if (!(rate > 0)) return;
  static const double outer = 1.0 / (2.0 - std::cbrt(2.0)), inner = 1.0 - 2.0 * outer;
  const int pieces = std::max(1, static_cast<int>(std::ceil(rate * dt / kLargestTurn)));
  const double h = dt / pieces;
  for (int n = 0; n < pieces; ++n) {
    strang(q, l, inertia, outer * h);
    strang(q, l, inertia, inner * h);
    strang(q, l, inertia, outer * h);
  }
  orientation = q.normalized();
}

void turn(Quat& orientation, const Vec3& rotation) {
  const double angle = rotation.norm();
  if (angle > 0) orientation = (Quat(Eigen::AngleAxisd(angle, rotation / angle)) * orientation).normalized();
}

}  // namespace ejecta
