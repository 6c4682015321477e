#include "shape/superquadric.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "shape/polytope_shape.hpp"

namespace ejecta {
namespace {

/// Exponent up to which a surface is round everywhere: beyond it caps on its flat sides lose up to 10 % of an
/// impact's energy (2 % up to it), and its polytope does not.
constexpr double kRoundest = 4;
constexpr int kLevels = 3;  // of the icosphere: 1280 triangles, within 0.3 % of the radius of an ellipsoid

/// Integral of z^p (1 - z^n)^(k/n) over [0, 1] = Beta((p + 1)/n, k/n + 1)/n.
double axial(double p, double k, double n) { return std::beta((p + 1) / n, k / n + 1) / n; }

/// Integral of u^p over the quarter u^n + v^n <= 1 (Dirichlet 1839).
double quarter(double p, double n) { return axial(p, 1, n); }

/// Exact, by the integrals of Dirichlet. `half`: half axes.
MassProperties mass_superquadric(const Vec3& half, double along, double across) {
  const double volume = 8 * half.prod() * quarter(0, across) * axial(0, 2, along);
  const double x2 = quarter(2, across) * axial(0, 4, along) / (quarter(0, across) * axial(0, 2, along));
  const double z2 = axial(2, 2, along) / axial(0, 2, along);
  const Vec3 square = half.cwiseAbs2().cwiseProduct(Vec3(x2, x2, z2));
  MassProperties m;
  m.volume = volume;
  m.inertia = (volume * (Vec3::Constant(square.sum()) - square)).asDiagonal();
  return m;
}

constexpr double kDeepestCap =
    0.75;  // of the way from the surface to the centre: rays from there still spread
constexpr int kRings = 3, kSpokes = 16;  // of a cap: its volume is 6 % too small

double power(double x, double exponent) {
  return exponent == 1 ? x : exponent == 2 ? x * x : std::pow(x, exponent);
}

/// (u^n + v^n)^(1/n) for u, v >= 0; n may be infinite. The larger one is taken out, so that no power
/// overflows.
double norm_of(double u, double v, double n) {
  if (n == 2) return std::sqrt(u * u + v * v);
  const double most = std::max(u, v);
  if (!(most > 0)) return 0.0;
  return most * std::pow(1 + std::pow(std::min(u, v) / most, n), 1 / n);
}

/// Gauge of a superquadric of half axes 1 and its derivative along `u`.
struct Slope {
  double value = 0.0, slope = 0.0;
};
Slope gauge_along(const Superquadric& s, const Vec3& p, const Vec3& u) {
  const Vec3 a = p.cwiseAbs();
  const double r = norm_of(a.x(), a.y(), s.across), g = norm_of(r, a.z(), s.along);
  const auto part = [](double x, double whole, double n) {
    return whole > 0 ? power(std::abs(x) / whole, n - 1) * (x < 0 ? -1.0 : 1.0) : 0.0;
  };
  const double turn = part(p.x(), r, s.across) * u.x() + part(p.y(), r, s.across) * u.y();
  return {g, part(r, g, s.along) * turn + part(p.z(), g, s.along) * u.z()};
}

/// How far from p, which lies inside, the surface is along u: both for half axes 1. The gauge is convex, so
/// that from outside Newton's steps come near from one side only. `guess`: about how far.
double way_to_surface(const Superquadric& s, const Vec3& p, const Vec3& u, double guess) {
  double r = guess;
  Slope at = gauge_along(s, p + r * u, u);
  while (!(at.value > 1)) {
    r *= 1.5;
    at = gauge_along(s, p + r * u, u);
  }
  for (int n = 0; n < 60; ++n) {
    const double step = (at.value - 1) / at.slope;
    r -= step;
    if (!(step > 1e-14 * r)) break;
    at = gauge_along(s, p + r * u, u);
    if (!(at.value > 1)) break;
  }
  return r;
}

}  // namespace

double Superquadric::gauge(const Vec3& p) const {
  const Vec3 a = p.cwiseAbs().cwiseQuotient(half);
  return norm_of(norm_of(a.x(), a.y(), across), a.z(), along);
}

Vec3 Superquadric::support(const Vec3& direction) const {
  // The gradient of the dual norm, whose exponents are n/(n - 1).
  const double flat = across / (across - 1), up = along / (along - 1);
  const Vec3 d = direction.cwiseProduct(half), a = d.cwiseAbs();
  const double r = norm_of(a.x(), a.y(), flat), whole = norm_of(r, a.z(), up);
  if (!(whole > 0)) return Vec3(0, 0, half.z());
  const auto part = [](double x, double all, double n) { return all > 0 ? power(x / all, n - 1) : 0.0; };
  const double ring = part(r, whole, up);
  const Vec3 p(ring * part(a.x(), r, flat), ring * part(a.y(), r, flat), part(a.z(), whole, up));
  const Vec3 signs = d.unaryExpr([](double x) { return x < 0 ? -1.0 : 1.0; });
  const Vec3 point = p.cwiseProduct(signs).cwiseProduct(half);
  return point / gauge(point);  // between two corners of one without a smooth edge
}

double Superquadric::radius() const {
  const auto farthest = [](double u, double v, double n) {
    return n > 2 ? norm_of(u, v, 2 * n / (n - 2)) : std::max(u, v);
  };
  return farthest(farthest(half.x(), half.y(), across), half.z(), along);
}

bool cut_cap(const Superquadric& solid, const Vec3& normal, double depth, Polytope& cap) {
  const Vec3 top = solid.support(normal);
  const double height = normal.dot(top);
  if (!(depth < kDeepestCap * height)) return false;
  // In axes in which the half axes are 1 spokes leave the middle of the rim's plane, and each of their points
  // is thrown onto the surface by a ray from the centre.
  const Superquadric unit{Vec3(1, 1, 1), solid.across, solid.along};
  const Vec3 pole = top.cwiseQuotient(solid.half), middle = (1 - depth / height) * pole;
  const Vec3 up = normal.cwiseProduct(solid.half).normalized(), u = up.unitOrthogonal(), v = up.cross(u);
  cap.vertices.assign(1, top);
  double reach = 0.5;
  for (int n = 0; n < kSpokes; ++n) {
    const double angle = 2 * std::numbers::pi * n / kSpokes;
    const Vec3 spoke = std::cos(angle) * u + std::sin(angle) * v;
    reach = way_to_surface(unit, middle, spoke, 1.2 * reach);
    for (int k = 1; k <= kRings; ++k) {
      const Vec3 p = middle + reach * k / kRings * spoke;
      cap.vertices.push_back(solid.half.cwiseProduct(p / unit.gauge(p)));
    }
  }
  cap.faces.clear();
  cap.corners.clear();
  const auto vertex = [&](int n) -> const Vec3& { return cap.vertices[static_cast<std::size_t>(n)]; };
  const auto add = [&](std::initializer_list<int> corners) {
    const int a = *corners.begin(), b = *(corners.begin() + 1), c = *(corners.begin() + 2);
    const Vec3 twice = (vertex(b) - vertex(a)).cross(vertex(c) - vertex(a));
    const double area = twice.norm();
    if (!(area > 0)) return;  // where its surface is flat to the last digit
    const Vec3 out = twice / area;
    cap.faces.push_back({out, out.dot(vertex(a)), static_cast<int>(cap.corners.size()), 3});
    cap.corners.insert(cap.corners.end(), corners);
  };
  for (int n = 0; n < kSpokes; ++n) {
    const int here = 1 + kRings * n, next = 1 + kRings * ((n + 1) % kSpokes);
    add({0, here, next});
    for (int k = 0; k + 1 < kRings; ++k) {
      const int a = here + k, b = a + 1, d = next + k, c = d + 1;
      // Along the diagonal that leaves the cap convex.
      const bool across_ac =
          (vertex(b) - vertex(a)).cross(vertex(c) - vertex(a)).dot(vertex(d) - vertex(a)) <= 0;
      if (across_ac) {
        add({a, b, c});
        add({a, c, d});
      } else {
        add({a, b, d});
        add({b, c, d});
      }
    }
  }
  const int first = static_cast<int>(cap.corners.size());
  for (int n = kSpokes - 1; n >= 0; --n) cap.corners.push_back(kRings * (n + 1));
  cap.faces.push_back({-normal, depth - height, first, kSpokes});
  cap.centre = top * (1 - 0.5 * depth / height);
  double farthest = 0.0;
  for (const Vec3& p : cap.vertices) farthest = std::max(farthest, (p - cap.centre).squaredNorm());
  cap.radius = std::sqrt(farthest);
  return true;
}

Shape make_superquadric(const Vec3& size, double across, double along) {
  for (int c = 0; c < 3; ++c)
    if (!(size[c] > 0) || !std::isfinite(size[c]))
      throw InputError(
          fmt::format("each edge of a superquadric must be a positive length, not {} m", size[c]),
          {.key = "size", .expected = "three lengths", .example = "size = [\"10 mm\", \"8 mm\", \"6 mm\"]"});
  for (const double e : {across, along})
    if (!(e >= 1.0 && e <= 20.0))
      throw InputError(
          fmt::format("exponent {} of a superquadric: below 1 it is not convex, above 20 take a box", e),
          {.key = "exponents",
           .expected = "from 1 to 20; 2 and 2: an ellipsoid",
           .example = "exponents = [4, 4]"});
  std::vector<Vec3> points;
  for (const Vec3& d : icosphere(kLevels).vertices) {
    const Vec3 a = d.cwiseAbs();
    const double r = std::pow(std::pow(a.x(), across) + std::pow(a.y(), across), 1 / across);
    const double reach = std::pow(std::pow(r, along) + std::pow(a.z(), along), 1 / along);
    points.push_back(0.5 * size.cwiseProduct(d) / reach);
  }
  Polytope hull = convex_hull(points);
  TriangleMesh surface = triangles_of(hull);
  if (across <= kRoundest && along <= kRoundest) {
    auto exact = std::make_shared<Superquadric>(Superquadric{0.5 * size, across, along});
    hull.radius = exact->radius() + hull.centre.norm();
    for (const Polytope::Face& f : hull.faces)
      hull.excess = std::max(hull.excess, f.normal.dot(exact->support(f.normal)) / f.offset);
    hull.exact = std::move(exact);
  }
  return make_polytope_shape({std::move(hull)}, std::move(surface),
                             mass_superquadric(0.5 * size, along, across));
}

}  // namespace ejecta
