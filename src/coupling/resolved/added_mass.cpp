#include "coupling/resolved/added_mass.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace ejecta {
namespace {

/// Carlson's integral R_D(x, y, z), 3/2 int_0^inf dt / ((t + z) sqrt((t + x)(t + y)(t + z))), by duplication
/// (Carlson 1979, Numer. Math. 33:1).
double carlson_rd(double x, double y, double z) {
  double sum = 0, factor = 1;
  for (int n = 0; n < 40; ++n) {
    const double root = std::sqrt(x * y) + std::sqrt(x * z) + std::sqrt(y * z);
    sum += factor / (std::sqrt(z) * (z + root));
    factor *= 0.25;
    x = 0.25 * (x + root), y = 0.25 * (y + root), z = 0.25 * (z + root);
  }
  return 3 * sum + factor / (z * std::sqrt(z));
}

/// The semi-axes, m, of the ellipsoid with the volume and the ratios of moments of the body.
std::array<double, 3> semi_axes(const MassProperties& body) {
  constexpr double kThinnest = 1e-3;  // of the longest
  const Vec3 moments = body.inertia.diagonal();
  std::array<double, 3> a{};
  for (int d = 0; d < 3; ++d)
    a[static_cast<std::size_t>(d)] = std::sqrt(std::max(0.5 * moments.sum() - moments[d], 0.0));
  const double longest = *std::max_element(a.begin(), a.end());
  for (double& length : a) length = std::max(length, kThinnest * longest);
  const double scale = std::cbrt(body.volume * 0.75 / M_PI / (a[0] * a[1] * a[2]));
  for (double& length : a) length *= scale;
  return a;
}

}  // namespace

AddedMass added_mass(const MassProperties& body, double density) {
  const std::array<double, 3> a = semi_axes(body);
  const double displaced = density * body.volume;
  std::array<double, 3> alpha{};
  for (std::size_t d = 0; d < 3; ++d) {
    const std::size_t e = (d + 1) % 3, f = (d + 2) % 3;
    alpha[d] = 2.0 / 3 * a[0] * a[1] * a[2] * carlson_rd(a[e] * a[e], a[f] * a[f], a[d] * a[d]);
  }
  AddedMass added;
  for (std::size_t d = 0; d < 3; ++d) {
    const std::size_t e = (d + 1) % 3, f = (d + 2) % 3;
    const double be = a[e] * a[e], bf = a[f] * a[f], lean = be - bf, of_pressure = alpha[f] - alpha[e];
    added.mass[static_cast<int>(d)] = displaced * alpha[d] / (2 - alpha[d]);
    if (std::abs(lean) > 1e-9 * (be + bf))
      added.inertia[static_cast<int>(d)] =
          0.2 * displaced * lean * lean * of_pressure / (2 * lean - (be + bf) * of_pressure);
  }
  return added;
}

}  // namespace ejecta
