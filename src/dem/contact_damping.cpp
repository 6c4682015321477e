#include "dem/contact_damping.hpp"

#include <cmath>
#include <numbers>

namespace ejecta {
namespace {

double clamped_restitution(double gamma) {
  const double z = 0.5 * gamma, square = 1 - z * z, w = std::sqrt(std::abs(square));
  if (w < 1e-6) return std::exp(-2.0);
  const double time = square > 0 ? std::atan2(2 * z * w, 2 * z * z - 1) : std::log((z + w) / (z - w));
  return std::exp(-z / w * time);
}

}  // namespace

double contact_damping(double restitution, bool allow_tension) {
  if (restitution >= 1.0) return 0.0;
  if (allow_tension) {
    const double log = std::log(restitution);
    return -2.0 * log / std::sqrt(log * log + std::numbers::pi * std::numbers::pi);
  }
  double low = 0.0, high = 1.0;
  while (clamped_restitution(high) > restitution) high *= 2.0;
  for (int n = 0; n < 60; ++n) {
    const double mid = 0.5 * (low + high);
    (clamped_restitution(mid) > restitution ? low : high) = mid;
  }
  return 0.5 * (low + high);
}

}  // namespace ejecta
