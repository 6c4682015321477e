#include "coupling/unresolved/eddy_walk.hpp"

#include <gtest/gtest.h>

#include <cmath>

/// Dispersion by turbulence: how far grains get in even turbulence, for any step.
namespace ejecta {
namespace {

constexpr double kEnergy = 6.0, kDissipation = 90.0;  // m2/s2, m2/s3: 2 m/s, eddies of 20 ms

/// Mean square of the way along an axis over the time, m2/s: twice the diffusivity.
double spreading(const EddyAround& around, double dt, double time) {
  constexpr std::size_t kGrains = 4000;
  EddyWalk walk(3);
  walk.grow(kGrains);
  double sum = 0;
  for (std::size_t g = 0; g < kGrains; ++g) {
    Vec3 way(0, 0, 0);
    for (int n = 0; n < std::lround(time / dt); ++n) way += dt * walk.velocity(g, around, dt);
    sum += way.squaredNorm() / 3;
  }
  return sum / kGrains / time;
}

/// Grains that follow the fluid spread with 2 D = (2 k / 3) 2 T_L, T_L = 0.15 k / epsilon, whether a step is
/// a part of an eddy's life or many of them.
TEST(EddyWalk, SpreadsAsTheLagrangianTimeSaysForAnyStep) {
  const double life = 0.3 * kEnergy / kDissipation, right = 2 * kEnergy / 3 * life;
  const EddyAround around{.k = kEnergy, .epsilon = kDissipation, .slip = 0.0, .relaxation = 1e-6};
  for (const double step : {0.13, 1.0, 2.7, 40.0})
    EXPECT_NEAR(spreading(around, step * life, 400 * life) / right, 1.0, 0.04)
        << step;  // 4000 x 3 ways: 1.3 %
}

/// A grain that flies through eddies meets each for as long as it needs to cross it.
TEST(EddyWalk, FastGrainsCrossEddies) {
  const double size = std::pow(0.09, 0.75) * std::pow(kEnergy, 1.5) / kDissipation, slip = 100.0;
  const EddyAround around{.k = kEnergy, .epsilon = kDissipation, .slip = slip, .relaxation = 10.0};
  EXPECT_NEAR(spreading(around, 1e-4, 0.2) / (2 * kEnergy / 3 * size / slip), 1.0, 0.04);
}

TEST(EddyWalk, IsStillWhereThereIsNoTurbulence) {
  EddyWalk walk(3);
  walk.grow(1);
  EXPECT_EQ(walk.velocity(0, {.k = 0.0, .epsilon = 1.0, .slip = 1.0, .relaxation = 1.0}, 1e-3).norm(), 0.0);
}

}  // namespace
}  // namespace ejecta
