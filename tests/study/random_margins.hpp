#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "base/random.hpp"
#include "study/margin_process.hpp"

namespace ejecta {

using Margin = std::function<double(double, double)>;  // m, m -> m

/// Margins drawn from families that the map knows nothing of: outlines that are random Fourier series of the
/// angle, heaps of bumps, polygons with kinks, valleys of a moved and bent jet. Each with a random saturation
/// on either side, and half of them with ripples or noise up to 1 mm. Even in y; in a window of 120 x 60 mm.
inline Margin random_margin(int n) {
  const CounterRandom random(2024, static_cast<std::uint64_t>(n));
  std::uint64_t used = 0;
  const auto between = [&](double low, double high) { return low + (high - low) * random.uniform(used++); };
  const double x0 = between(-0.012, 0.012), size_x = between(0.018, 0.036), size_y = between(0.009, 0.019);
  const double slope = between(0.6, 4.0);  // m a m at the boundary, roughly
  Margin distance;                         // m, roughly the distance to the boundary
  switch (n % 4) {
    case 0: {
      std::array<double, 4> a;
      for (double& v : a) v = between(-0.1, 0.1);
      distance = [=](double x, double y) {
        const double u = (x - x0) / size_x, v = y / size_y, angle = std::atan2(v, u);
        double radius = 1.0;
        for (std::size_t k = 0; k < a.size(); ++k) radius += a[k] * std::cos(double(k + 1) * angle);
        return size_y * (radius - std::hypot(u, v));
      };
      break;
    }
    case 1: {
      struct Bump {
        double x, y, width, height;
      };
      std::array<Bump, 3> bumps;
      for (Bump& b : bumps)
        b = {x0 + between(-0.7, 0.7) * size_x, between(0.0, 0.5) * size_y, between(0.7, 1.2),
             between(0.5, 1.0)};
      distance = [=](double x, double y) {
        double sum = -0.45;
        for (const Bump& b : bumps)
          for (const double side : {-1.0, 1.0}) {
            const double u = (x - b.x) / (b.width * size_x), v = (y - side * b.y) / (b.width * size_y);
            sum += 0.5 * b.height * std::exp(-u * u - v * v);
          }
        return size_y * sum;
      };
      break;
    }
    case 2: {
      struct Side {
        double x, y, at;
      };
      std::array<Side, 5> sides;
      for (std::size_t k = 0; k < sides.size(); ++k) {
        const double angle = std::numbers::pi * (double(k) + between(0.2, 0.8)) / double(sides.size());
        sides[k] = {std::cos(angle), std::sin(angle), between(0.8, 1.1)};
      }
      distance = [=](double x, double y) {
        double least = 1.0;
        for (const Side& s : sides)
          least = std::min(least, s.at - s.x * (x - x0) / size_x - s.y * std::abs(y) / size_y);
        return size_y * least;
      };
      break;
    }
    default: {
      const double tip = between(-0.5, 0.5), power = between(1.5, 4.0);
      distance = [=](double x, double y) {
        const double u = (x - x0) / size_x, v = std::abs(y) / (size_y * (1.0 + tip * std::tanh(u)));
        return size_y * (1.0 - std::pow(std::abs(u), power) - std::pow(v, power));
      };
    }
  }
  const double top = between(0.004, 0.06), floor = between(0.004, 0.03);
  const bool disturbed = random.uniform(used++) < 0.5, noisy = random.uniform(used++) < 0.5;
  const double disturbance = disturbed ? between(0.0, 1e-3) : 0.0, wave = between(0.005, 0.015);
  return [=](double x, double y) {
    const double m = slope * distance(x, y);
    const double saturated = m > 0.0      ? top * std::tanh(m / top)
                             : n % 3 == 0 ? std::max(m, -floor)
                                          : floor * std::tanh(m / floor);
    const auto key =
        static_cast<std::uint64_t>(std::llround(x * 1e6) * 1000003 + std::llround(std::abs(y) * 1e6));
    const double shake =
        noisy ? CounterRandom(7, static_cast<std::uint64_t>(n)).normal(key)
              : std::sin(2.0 * std::numbers::pi * x / wave) * std::cos(2.0 * std::numbers::pi * y / wave);
    return saturated + disturbance * shake;
  };
}

/// Area in which the margin is positive, m2, by counting points.
inline double counted_area(const Margin& margin, const Window& w, int across = 1200) {
  int inside = 0;
  for (int j = 0; j < across; ++j)
    for (int i = 0; i < across; ++i)
      inside +=
          margin(w.x_low + w.width() * (i + 0.5) / across, w.y_low + w.depth() * (j + 0.5) / across) > 0.0;
  return w.width() * w.depth() * inside / (double(across) * across);
}

}  // namespace ejecta
