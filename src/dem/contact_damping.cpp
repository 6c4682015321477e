#include "dem/contact_damping.hpp"

#include <cmath>
#include <numbers>

namespace ejecta {
namespace {

/// Restitution of x'' = -x^(1+p) - alpha x^(p/2) x', x = 0, x' = 1 at first, clamped at F >= 0.
double clamped_restitution(double alpha, double p) {
  const auto force = [&](double x, double v) {
    const double d = std::max(x, 0.0);
    return std::pow(d, 1.0 + p) + alpha * std::pow(d, 0.5 * p) * v;
  };
  double x = 0.0, v = 1.0;
  // The dashpot of Hertz's law is not smooth at first touch: start with tiny steps.
  for (double t = 0.0;;) {
    const double h = std::min(1e-3, 1e-6 + 0.01 * t);
    const double v2 = v - 0.5 * h * force(x, v), x2 = x + 0.5 * h * v;
    const double v3 = v - 0.5 * h * force(x2, v2), x3 = x + 0.5 * h * v2;
    const double v4 = v - h * force(x3, v3), x4 = x + h * v3;
    const double dv = -h / 6.0 * (force(x, v) + 2 * force(x2, v2) + 2 * force(x3, v3) + force(x4, v4));
    const double dx = h / 6.0 * (v + 2 * v2 + 2 * v3 + v4);
    t += h;
    if (v + dv < 0 && (x + dx <= 0 || force(x + dx, v + dv) <= 0)) return -(v + dv);
    x += dx;
    v += dv;
  }
}

double clamped_damping(double restitution, double p) {
  if (restitution >= 1.0) return 0.0;
  double low = 0.0, high = 1.0;
  while (clamped_restitution(high, p) > restitution) high *= 2.0;
  for (int n = 0; n < 40; ++n) {
    const double mid = 0.5 * (low + high);
    (clamped_restitution(mid, p) > restitution ? low : high) = mid;
  }
  return 0.5 * (low + high);
}

double with_tension(double restitution, double factor) {
  const double log = std::log(restitution);
  return -factor * log / std::sqrt(log * log + std::numbers::pi * std::numbers::pi);
}

}  // namespace

double damping_hertz(double restitution, bool allow_tension) {
  return allow_tension ? with_tension(restitution, std::sqrt(5.0)) : clamped_damping(restitution, 0.5);
}

double damping_linear(double restitution, bool allow_tension) {
  return allow_tension ? with_tension(restitution, 2.0) : clamped_damping(restitution, 0.0);
}

}  // namespace ejecta
