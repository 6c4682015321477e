#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "shape/mass_properties.hpp"

namespace ejecta {
namespace {

constexpr double kPi = std::numbers::pi;

// Gauss-Legendre on [-1, 1], 8 points.
constexpr std::array<double, 4> kNode{0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                      0.9602898564975363};
constexpr std::array<double, 4> kWeight{0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                        0.1012285362903763};

template <class F>
void gauss8(double a, double b, const F& f) {
  const double mid = 0.5 * (a + b), half = 0.5 * (b - a);
  for (std::size_t n = 0; n < 4; ++n) {
    f(mid - half * kNode[n], half * kWeight[n]);
    f(mid + half * kNode[n], half * kWeight[n]);
  }
}

using Disc = std::array<double, 3>;  // x, y, radius

/// Integrals of 1, x, y, x2, y2, xy over a plane region.
struct PlaneMoments {
  double m = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
};

/// Green's theorem along the arc of a disc from angle a to b, in pieces of at most a quarter turn.
void add_arc(PlaneMoments& sum, const Disc& d, double a, double b) {
  const int pieces = std::max(1, static_cast<int>(std::ceil((b - a) / (0.5 * kPi) - 1e-12)));
  for (int n = 0; n < pieces; ++n)
    gauss8(a + (b - a) * n / pieces, a + (b - a) * (n + 1) / pieces, [&](double angle, double weight) {
      const double c = std::cos(angle), s = std::sin(angle), r = d[2];
      const double x = d[0] + r * c, y = d[1] + r * s;
      const double dx = -r * s * weight, dy = r * c * weight;
      sum.m += 0.5 * (x * dy - y * dx);
      sum.x += 0.5 * x * x * dy;
      sum.y -= 0.5 * y * y * dx;
      sum.xx += x * x * x * dy / 3.0;
      sum.yy -= y * y * y * dx / 3.0;
      sum.xy += 0.5 * x * x * y * dy;
    });
}

/// The part of disc i's rim hidden by disc j as an interval of angles; {0, 0} if none.
std::pair<double, double> hidden_arc(const Disc& i, const Disc& j, bool equal_hides) {
  const double dx = j[0] - i[0], dy = j[1] - i[1], dist = std::hypot(dx, dy);
  if (dist >= i[2] + j[2]) return {0, 0};
  const double tiny = 1e-13 * (i[2] + j[2]);
  if (dist <= tiny && std::abs(i[2] - j[2]) <= tiny)
    return equal_hides ? std::pair{0.0, 2 * kPi} : std::pair{0.0, 0.0};
  if (dist <= j[2] - i[2]) return {0, 2 * kPi};
  if (dist <= i[2] - j[2]) return {0, 0};
  const double cosine = (dist * dist + i[2] * i[2] - j[2] * j[2]) / (2 * dist * i[2]);
  const double half = std::acos(std::clamp(cosine, -1.0, 1.0));
  double from = std::atan2(dy, dx) - half;
  if (from < 0) from += 2 * kPi;
  return {from, from + 2 * half};
}

PlaneMoments moments_discs(const std::vector<Disc>& discs) {
  PlaneMoments sum;
  std::vector<std::pair<double, double>> hidden;
  for (std::size_t i = 0; i < discs.size(); ++i) {
    hidden.clear();
    for (std::size_t j = 0; j < discs.size(); ++j) {
      if (j == i) continue;
      const auto [from, to] = hidden_arc(discs[i], discs[j], j < i);
      if (to > 2 * kPi) {
        hidden.emplace_back(from, 2 * kPi);
        hidden.emplace_back(0, to - 2 * kPi);
      } else if (to > from) {
        hidden.emplace_back(from, to);
      }
    }
    std::sort(hidden.begin(), hidden.end());
    double open = 0.0;
    for (const auto& [from, to] : hidden) {
      if (from > open) add_arc(sum, discs[i], open, from);
      open = std::max(open, to);
    }
    if (open < 2 * kPi) add_arc(sum, discs[i], open, 2 * kPi);
  }
  return sum;
}

/// Heights at which three spheres meet in a point.
void add_triple_points(std::vector<double>& heights, const Ball& a, const Ball& b, const Ball& c) {
  const Vec3 u = b.centre - a.centre, v = c.centre - a.centre, w = u.cross(v);
  const double w2 = w.squaredNorm();
  if (w2 < 1e-20 * u.squaredNorm() * v.squaredNorm()) return;
  const double p = 0.5 * (u.squaredNorm() + a.radius * a.radius - b.radius * b.radius);
  const double q = 0.5 * (v.squaredNorm() + a.radius * a.radius - c.radius * c.radius);
  const Vec3 foot = (p * v.cross(w) + q * w.cross(u)) / w2;
  const double h2 = a.radius * a.radius - foot.squaredNorm();
  if (h2 < 0) return;
  const double rise = std::sqrt(h2 / w2) * w.z();
  heights.push_back(a.centre.z() + foot.z() + rise);
  heights.push_back(a.centre.z() + foot.z() - rise);
}

/// Heights where the arcs of the slices appear, vanish or meet: between them the integrand is analytic.
std::vector<double> breakpoints(const std::vector<Ball>& balls) {
  std::vector<double> heights;
  const auto meet = [&](std::size_t i, std::size_t j) {
    return (balls[i].centre - balls[j].centre).norm() < balls[i].radius + balls[j].radius;
  };
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const Ball& a = balls[i];
    heights.push_back(a.centre.z() - a.radius);
    heights.push_back(a.centre.z() + a.radius);
    for (std::size_t j = i + 1; j < balls.size(); ++j) {
      if (!meet(i, j)) continue;
      const Ball& b = balls[j];
      const Vec3 axis = b.centre - a.centre;
      const double dist = axis.norm();
      if (dist > 0) {
        const double along = (dist * dist + a.radius * a.radius - b.radius * b.radius) / (2 * dist);
        const double rim2 = a.radius * a.radius - along * along;
        if (rim2 > 0) {
          const double middle = a.centre.z() + along * axis.z() / dist;
          const double reach = std::sqrt(rim2) * std::hypot(axis.x(), axis.y()) / dist;
          heights.push_back(middle - reach);
          heights.push_back(middle + reach);
        }
      }
      for (std::size_t k = j + 1; k < balls.size(); ++k)
        if (meet(i, k) && meet(j, k)) add_triple_points(heights, a, b, balls[k]);
    }
  }
  std::sort(heights.begin(), heights.end());
  const double tiny = 1e-10 * (heights.back() - heights.front());
  std::vector<double> distinct{heights.front()};
  for (const double h : heights)
    if (h - distinct.back() > tiny) distinct.push_back(h);
  return distinct;
}

}  // namespace

double area_discs(const std::vector<Disc>& discs) { return moments_discs(discs).m; }

MassProperties mass_balls(const std::vector<Ball>& balls) {
  if (balls.size() == 1) {
    MassProperties m = mass_sphere(balls.front().radius);
    m.centre = balls.front().centre;
    return m;
  }
  const std::vector<double> heights = breakpoints(balls);
  Moments sum;
  std::vector<Disc> discs;
  for (std::size_t n = 0; n + 1 < heights.size(); ++n) {
    const double mid = 0.5 * (heights[n] + heights[n + 1]), half = 0.5 * (heights[n + 1] - heights[n]);
    // z = mid + half sin(s) takes away the square-root behaviour of arcs at the ends of the interval.
    for (const auto& [from, to] : {std::pair{-0.5 * kPi, 0.0}, std::pair{0.0, 0.5 * kPi}})
      gauss8(from, to, [&](double s, double weight) {
        const double z = mid + half * std::sin(s), dz = half * std::cos(s) * weight;
        discs.clear();
        for (const Ball& b : balls) {
          const double rim2 = b.radius * b.radius - (z - b.centre.z()) * (z - b.centre.z());
          if (rim2 > 0) discs.push_back({b.centre.x(), b.centre.y(), std::sqrt(rim2)});
        }
        const PlaneMoments p = moments_discs(discs);
        Moments slice;
        slice.volume = p.m;
        slice.first = Vec3(p.x, p.y, p.m * z);
        slice.second << p.xx, p.xy, p.x * z, p.xy, p.yy, p.y * z, p.x * z, p.y * z, p.m * z * z;
        sum += {slice.volume * dz, slice.first * dz, slice.second * dz};
      });
  }
  return sum.mass_properties();
}

}  // namespace ejecta
