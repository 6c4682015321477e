#include "study/design.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace ejecta {
namespace {

std::vector<double> coordinate(const Samples& samples, std::size_t d) {
  std::vector<double> values;
  for (const auto& point : samples) values.push_back(point[d]);
  return values;
}

TEST(LatinHypercube, EachPartOfEachRangeIsTakenOnce) {
  const Samples samples = latin_hypercube(20, 3, 5);
  for (std::size_t d = 0; d < 3; ++d) {
    std::set<int> parts;
    for (const double v : coordinate(samples, d)) parts.insert(static_cast<int>(20 * v));
    EXPECT_EQ(parts.size(), 20u) << d;
    EXPECT_EQ(*parts.rbegin(), 19);
  }
  EXPECT_NE(coordinate(samples, 0), coordinate(samples, 1));
  EXPECT_EQ(samples, latin_hypercube(20, 3, 5));
  EXPECT_NE(samples, latin_hypercube(20, 3, 6));
}

/// The sequence before it was moved: its first point is zero.
double unmoved(const Samples& samples, std::size_t point, std::size_t d) {
  double v = samples[point][d] - samples[0][d];
  v -= std::floor(v + 1e-12);
  return v;
}

TEST(Sobol, EveryDimensionIsFilledEvenly) {
  const Samples samples = sobol(256, kSobolDimensions, 1);
  for (std::size_t d = 0; d < kSobolDimensions; ++d) {
    std::set<int> parts;
    for (std::size_t n = 0; n < 256; ++n) parts.insert(static_cast<int>(256 * unmoved(samples, n, d) + 1e-6));
    EXPECT_EQ(parts.size(), 256u) << d;
  }
}

TEST(Sobol, TheFirstTwoDimensionsAreANet) {
  // (0, 4, 2)-net: each box of 1/16 of the area, whatever its form, holds one of 16 points.
  const Samples samples = sobol(16, 2, 1);
  for (const int along : {1, 2, 4, 8, 16}) {
    std::set<std::pair<int, int>> boxes;
    for (std::size_t n = 0; n < 16; ++n)
      boxes.insert({static_cast<int>(along * unmoved(samples, n, 0) + 1e-9),
                    static_cast<int>(16 / along * unmoved(samples, n, 1) + 1e-9)});
    EXPECT_EQ(boxes.size(), 16u) << along;
  }
}

TEST(Sobol, IntegratesAProductBetterThanChance) {
  // Integral of the product of pi/2 sin(pi x) over eight dimensions: 1. Random points err by
  // sqrt(((pi^2/8)^8 - 1) / n).
  const int n = 4096, seeds = 10;
  double square = 0.0;
  for (int seed = 0; seed < seeds; ++seed) {
    double sum = 0.0;
    for (const auto& point : sobol(n, 8, seed)) {
      double product = 1.0;
      for (const double x : point) product *= 0.5 * M_PI * std::sin(M_PI * x);
      sum += product / n;
    }
    square += (sum - 1.0) * (sum - 1.0) / seeds;
  }
  EXPECT_LT(std::sqrt(square), 0.3 * std::sqrt((std::pow(M_PI * M_PI / 8.0, 8) - 1.0) / n));
}

}  // namespace
}  // namespace ejecta
