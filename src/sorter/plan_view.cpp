#include "sorter/plan_view.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "sorter/feed_particle.hpp"

namespace ejecta {
namespace {

double turn_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// A side of `a` has all of `b` beyond it.
bool parted_by_side(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  for (std::size_t n = 0; n < a.size(); ++n) {
    const Vec3 &from = a[n], &to = a[(n + 1) % a.size()];
    if (std::all_of(b.begin(), b.end(), [&](const Vec3& p) { return turn_of(from, to, p) < 0.0; }))
      return true;
  }
  return false;
}

double square_distance(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double t = std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
  return (p - a - t * ab).squaredNorm();
}

/// Of the corners of `a` to the sides of `b`.
bool corner_near(const std::vector<Vec3>& a, const std::vector<Vec3>& b, double gap) {
  for (const Vec3& p : a)
    for (std::size_t n = 0; n < b.size(); ++n)
      if (square_distance(p, b[n], b[(n + 1) % b.size()]) <= gap * gap) return true;
  return false;
}

}  // namespace

std::vector<Vec3> convex_outline(std::vector<Vec3> points) {
  std::sort(points.begin(), points.end(),
            [](const Vec3& a, const Vec3& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
  std::vector<Vec3> hull;
  for (int side = 0; side < 2; ++side) {  // lower, then upper
    const std::size_t start = hull.size();
    for (const Vec3& p : points) {
      while (hull.size() >= start + 2 && turn_of(hull[hull.size() - 2], hull.back(), p) <= 1e-15)
        hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

double area_of_outline(const std::vector<Vec3>& outline) {
  double sum = 0.0;
  for (std::size_t n = 0; n < outline.size(); ++n) {
    const Vec3 &a = outline[n], &b = outline[(n + 1) % outline.size()];
    sum += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  return sum;
}

double perimeter_of_outline(const std::vector<Vec3>& outline) {
  double sum = 0.0;
  for (std::size_t n = 0; n < outline.size(); ++n)
    sum += (outline[(n + 1) % outline.size()] - outline[n]).norm();
  return sum;
}

bool within_gap(const std::vector<Vec3>& a, const std::vector<Vec3>& b, double gap) {
  if (!parted_by_side(a, b) && !parted_by_side(b, a)) return true;  // convex: they overlap
  return corner_near(a, b, gap) || corner_near(b, a, gap);
}

Quat orientation_of(const FeedParticle& p) {
  return Quat(Eigen::AngleAxisd(p.yaw, Vec3::UnitZ())) * p.tilt * p.prototype->resting;
}

double plan_area(const FeedParticle& p) {
  return p.tilt.vec() == Vec3::Zero() ? p.scale * p.scale * p.prototype->area
                                      : area_of_outline(outline_of(p));
}

std::vector<Vec3> outline_of(const FeedParticle& p) {
  if (p.tilt.vec() != Vec3::Zero()) {
    const Quat turn = orientation_of(p);
    std::vector<Vec3> points;
    for (const Vec3& v : p.prototype->corners) {
      const Vec3 at = p.scale * (turn * v);
      points.push_back({p.x - at.x(), p.y + at.y(), 0.0});
    }
    return convex_outline(std::move(points));
  }
  const double c = std::cos(p.yaw), s = std::sin(p.yaw);
  std::vector<Vec3> out;
  out.reserve(p.prototype->outline.size());
  // The strip's x runs against the motion: mirrored there, and the other way round to stay counter-clockwise.
  for (auto v = p.prototype->outline.rbegin(); v != p.prototype->outline.rend(); ++v)
    out.push_back(
        {p.x - p.scale * (c * v->x() - s * v->y()), p.y + p.scale * (s * v->x() + c * v->y()), 0.0});
  return out;
}

}  // namespace ejecta
