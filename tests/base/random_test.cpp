#include "base/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace ejecta {
namespace {

TEST(CounterRandom, GivesThePublishedBits) {
  // Known answers of Philox 4x32-10 in the Random123 library, kat_vectors.
  const auto zero = CounterRandom(0, 0).bits(0);
  EXPECT_EQ(zero, (std::array<std::uint32_t, 4>{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  const auto ones = CounterRandom(~std::uint64_t{0}, ~std::uint64_t{0}).bits(~std::uint64_t{0});
  EXPECT_EQ(ones, (std::array<std::uint32_t, 4>{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
}

TEST(CounterRandom, UniformAndNormalHaveTheirMoments) {
  const CounterRandom random(3, 5);
  constexpr int kCount = 100000;
  double mean = 0.0, square = 0.0, fourth = 0.0, least = 1.0, most = 0.0, sum = 0.0;
  for (int n = 0; n < kCount; ++n) {
    const double u = random.uniform(static_cast<std::uint64_t>(n));
    least = std::min(least, u);
    most = std::max(most, u);
    sum += u;
    for (const double z : random.normals(static_cast<std::uint64_t>(n))) {
      mean += z;
      square += z * z;
      fourth += z * z * z * z;
    }
  }
  EXPECT_GT(least, 0.0);
  EXPECT_LT(most, 1.0);
  EXPECT_NEAR(sum / kCount, 0.5, 4.0 * 0.289 / std::sqrt(kCount));
  EXPECT_NEAR(mean / (2 * kCount), 0.0, 4.0 / std::sqrt(2.0 * kCount));
  EXPECT_NEAR(square / (2 * kCount), 1.0, 4.0 * std::sqrt(2.0 / (2.0 * kCount)));
  EXPECT_NEAR(fourth / (2 * kCount), 3.0, 4.0 * std::sqrt(96.0 / (2.0 * kCount)));
}

}  // namespace
}  // namespace ejecta
