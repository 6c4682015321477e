#include <fmt/format.h>

#include <cmath>

#include "base/error.hpp"
#include "shape/polytope_shape.hpp"

namespace ejecta {
namespace {

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

}  // namespace

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
  return make_polytope_shape({std::move(hull)}, std::move(surface),
                             mass_superquadric(0.5 * size, along, across));
}

}  // namespace ejecta
