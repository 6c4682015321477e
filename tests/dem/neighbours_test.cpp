#include "dem/neighbours.hpp"

#include <gtest/gtest.h>

#include <random>

/// Lumps among grains, found by cells of the size of grains: every pair, none twice, in order.
namespace ejecta {
namespace {

TEST(NeighbourSearch, FindsEveryPairOfLargeAndSmallItems) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  for (const int lumps : {0, 1, 7, 40}) {
    std::vector<NeighbourSearch::Item> items;
    for (int n = 0; n < 600; ++n) {
      const bool lump = n % 15 == 3 && n / 15 < lumps;
      const Vec3 at(part(random), part(random), part(random));
      items.push_back({at, lump ? 0.1 + 0.1 * part(random) : 0.01 + 0.01 * part(random), n / 2});
    }
    constexpr double kReach = 0.01;
    std::vector<std::pair<int, int>> right;
    for (int i = 0; i < 600; ++i)
      for (int j = i + 1; j < 600; ++j) {
        const auto &a = items[static_cast<std::size_t>(i)], &b = items[static_cast<std::size_t>(j)];
        if (a.body != b.body && (a.centre - b.centre).norm() < a.radius + b.radius + kReach)
          right.emplace_back(i, j);
      }
    NeighbourSearch search;
    EXPECT_EQ(search.find(items, kReach), right) << lumps;
    EXPECT_GT(right.size(), 5u);
  }
}

}  // namespace
}  // namespace ejecta
