#include "shape/primitives.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ejecta {
namespace {

const Ball& nearest_ball(const std::vector<Ball>& balls, const Vec3& p) {
  const Ball* nearest = &balls.front();
  double distance = (p - nearest->centre).norm() - nearest->radius;
  for (const Ball& ball : balls) {
    const double square = (p - ball.centre).squaredNorm(), reach = distance + ball.radius;
    if (reach > 0 && square >= reach * reach) continue;
    const double own = std::sqrt(square) - ball.radius;
    if (own < distance) nearest = &ball, distance = own;
  }
  return *nearest;
}

}  // namespace

double distance_balls(const std::vector<Ball>& balls, const Vec3& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n < balls.size(); ++n) {
    const double x = p[0] - balls[n].centre[0], y = p[1] - balls[n].centre[1], z = p[2] - balls[n].centre[2];
    const double square = x * x + y * y + z * z, reach = nearest + balls[n].radius;
    if (reach > 0 && square >= reach * reach) continue;  // most balls of a cluster, without a root
    nearest = std::min(nearest, std::sqrt(square) - balls[n].radius);
  }
  return nearest;
}

Vec3 gradient_balls(const std::vector<Ball>& balls, const Vec3& p) {
  const Vec3 out = p - nearest_ball(balls, p).centre;
  const double length = out.norm();
  return length > 0 ? Vec3(out / length) : Vec3::UnitZ();
}

Vec3 support_balls(const std::vector<Ball>& balls, const Vec3& direction) {
  const Vec3 d = direction.normalized();
  const Ball& ball = *std::max_element(balls.begin(), balls.end(), [&](const Ball& a, const Ball& b) {
    return d.dot(a.centre) + a.radius < d.dot(b.centre) + b.radius;
  });
  return ball.centre + ball.radius * d;
}

double distance_box(const Vec3& half, const Vec3& p) {
  const Vec3 q = p.cwiseAbs() - half;
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
}

Vec3 gradient_box(const Vec3& half, const Vec3& p) {
  const Vec3 q = p.cwiseAbs() - half;
  const Vec3 sign = p.unaryExpr([](double v) { return v < 0 ? -1.0 : 1.0; });
  const double nearest = q.maxCoeff();
  if (nearest > 0) return sign.cwiseProduct(q.cwiseMax(0.0)).normalized();
  // Equally near faces count alike: round-off must not choose one of them on one side of a turned box only.
  const double tie = nearest - 1e-9 * half.maxCoeff();
  return sign.cwiseProduct(q.unaryExpr([tie](double v) { return v > tie ? 1.0 : 0.0; })).normalized();
}

Vec3 support_box(const Vec3& half, const Vec3& direction) {
  return direction.unaryExpr([](double v) { return v < 0 ? -1.0 : 1.0; }).cwiseProduct(half);
}

}  // namespace ejecta
