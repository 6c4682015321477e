#include "dem/contact_law.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "dem/contact_damping.hpp"

namespace ejecta {
namespace {

using D = Triple<double>;

Contact<double> contact(double overlap, const D& velocity) {
  return {{0, 0, 1}, overlap, 2e-3, 1e-4, velocity};
}

const PairConstants<double> kPair{1e7, 2e6, 1e4, 0.3, 0.9, 0.4, 0.1};

/// Antypov & Elliott's alpha is sqrt(5/4) gamma: their formula and, for the clamped force, independent
/// integrations of Hertz's equation of motion.
TEST(Damping, HertzTableOfKnownValues) {
  const auto alpha = [](double e, bool tension) { return std::sqrt(1.25) * contact_damping(e, tension); };
  EXPECT_NEAR(alpha(0.3, true), 0.80019, 1e-5);
  EXPECT_NEAR(alpha(0.2, false), 1.6351, 1e-4);
  EXPECT_NEAR(alpha(0.3, false), 1.1119, 1e-4);
  EXPECT_NEAR(alpha(0.5, false), 0.5708, 1e-4);
  EXPECT_NEAR(alpha(0.7, false), 0.2733, 1e-4);
  EXPECT_NEAR(alpha(0.9, false), 0.0766, 1e-4);
  EXPECT_EQ(alpha(1.0, false), 0.0);
}

/// Force F(x) = x^q with the dashpot gamma F/sqrt(2 E), integrated with small steps to the instant of zero
/// force: a face, Hertz, an edge, a corner; also where the motion is overdamped.
TEST(Damping, GivesTheRestitutionWhateverTheLaw) {
  for (const double q : {1.0, 1.5, 2.0, 3.0})
    for (const double e : {0.02, 0.1, 0.5, 0.9}) {
      const double gamma = contact_damping(e, false), h = 1e-5;
      double x = 0.0, v = 1.0;
      for (long n = 0; n < 100000000; ++n) {
        const double middle = x + 0.5 * h * v;
        const double spring = std::pow(middle, q), energy = std::pow(middle, q + 1) / (q + 1);
        const double force = spring + gamma * spring / std::sqrt(2 * energy) * v;
        if (force <= 0 && v < 0) break;
        v -= h * force;
        x = middle + 0.5 * h * v;
      }
      EXPECT_NEAR(-v, e, 2e-3) << q;
    }
}

TEST(ContactLaw, HertzForceAndEnergy) {
  D slip;
  const auto f = contact_force<HertzMindlin>(contact(1e-5, {0, 0, 0}), kPair, false, 1e-6, slip);
  EXPECT_NEAR(f.normal, 4.0 / 3.0 * 1e7 * std::sqrt(2e-3) * std::pow(1e-5, 1.5), 1e-12);
  EXPECT_NEAR(f.elastic_normal, 0.4 * f.normal * 1e-5, 1e-18);
}

TEST(ContactLaw, FrictionNeverExceedsCoulombAndOpposesSliding) {
  D slip;
  for (int n = 0; n < 100; ++n) {
    const auto f = contact_force<HertzMindlin>(contact(1e-5, {0.3, -0.4, 0}), kPair, false, 1e-6, slip);
    const double size = std::hypot(f.force.x, f.force.y);
    EXPECT_LE(size, 0.4 * f.normal * (1 + 1e-12));
    EXPECT_LE(f.force.x, 0);
    EXPECT_GE(f.force.y, 0);
    if (n == 99) {
      EXPECT_NEAR(size, 0.4 * f.normal, 1e-12);
    }
  }
}

TEST(ContactLaw, NoTensionUnlessAllowed) {
  D slip;
  EXPECT_EQ(contact_force<HertzMindlin>(contact(1e-8, {0, 0, 5}), kPair, false, 1e-6, slip).normal, 0.0);
  EXPECT_LT(contact_force<HertzMindlin>(contact(1e-8, {0, 0, 5}), kPair, true, 1e-6, slip).normal, 0.0);
}

TEST(ContactLaw, LanesGiveWhatNumbersGive) {
  Contact<Lanes> wide;
  PairConstants<Lanes> pair{Lanes{} + 1e7, Lanes{} + 2e6, Lanes{} + 1e4, Lanes{} + 0.3,
                            Lanes{} + 0.9, Lanes{} + 0.4, Lanes{} + 0.1};
  Triple<Lanes> slip;
  for (int n = 0; n < kLanes; ++n) {
    wide.normal.z[n] = 1;
    wide.overlap[n] = 1e-6 * (n + 1);
    wide.radius[n] = 2e-3;
    wide.mass[n] = 1e-4;
    wide.velocity.x[n] = 0.1 * n;
    wide.velocity.z[n] = 0.2 - 0.1 * n;
  }
  const auto f = contact_force<HertzMindlin>(wide, pair, false, 1e-6, slip);
  for (int n = 0; n < kLanes; ++n) {
    D one;
    const auto g = contact_force<HertzMindlin>(contact(1e-6 * (n + 1), {0.1 * n, 0, 0.2 - 0.1 * n}), kPair,
                                               false, 1e-6, one);
    EXPECT_NEAR(f.force.x[n], g.force.x, 1e-14);
    EXPECT_NEAR(f.force.z[n], g.force.z, 1e-14);
    EXPECT_NEAR(slip.x[n], one.x, 1e-20);
  }
}

TEST(ContactLaw, RollingAndTwistingStopAtTheirLimits) {
  D slip, roll;
  Twist twist;
  const auto c = contact(1e-5, {0, 0, 0});
  const auto f = contact_force<HertzMindlin>(c, kPair, false, 1e-4, slip);
  D rolling, patch;
  for (int n = 0; n < 1000; ++n) {
    rolling = rolling_moment(c, kPair, f, D{10, 0, 3}, 1e-4, roll);
    patch = patch_moment(1e-3, c.normal, kPair, f, D{10, 0, 3}, 1.0, 1e-4, twist);
  }
  EXPECT_NEAR(rolling.x, -0.1 * 2e-3 * f.normal, 1e-15);
  EXPECT_EQ(rolling.z, 0.0);
  EXPECT_NEAR(patch.z, -2.0 / 3.0 * 0.4 * f.normal * 1e-3, 1e-15);
  EXPECT_NEAR(patch.x, -std::min(f.normal * 1e-3, 0.25e-6 * f.dashpot * 10), 1e-15);
}

}  // namespace
}  // namespace ejecta
