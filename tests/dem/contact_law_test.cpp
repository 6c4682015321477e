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

/// The formula of Antypov & Elliott 2011 and, for the clamped force, independent integrations.
TEST(Damping, HertzTableOfKnownValues) {
  EXPECT_NEAR(damping_hertz(0.3, true), 0.80019, 1e-5);
  EXPECT_NEAR(damping_hertz(0.2, false), 1.6351, 1e-4);
  EXPECT_NEAR(damping_hertz(0.3, false), 1.1119, 1e-4);
  EXPECT_NEAR(damping_hertz(0.5, false), 0.5708, 1e-4);
  EXPECT_NEAR(damping_hertz(0.7, false), 0.2733, 1e-4);
  EXPECT_NEAR(damping_hertz(0.9, false), 0.0766, 1e-4);
  EXPECT_EQ(damping_hertz(1.0, false), 0.0);
}

/// Schwager & Poeschel 2007, Granular Matter 9:465: e = exp(-z t/w), t = atan2(2 z w, 2 z^2 - 1) the time at
/// which the clamped force ends.
TEST(Damping, LinearMatchesTheClosedForm) {
  for (const double e : {0.2, 0.5, 0.9}) {
    const double z = 0.5 * damping_linear(e, false), w = std::sqrt(1 - z * z);
    const double time = std::atan2(2 * z * w, 2 * z * z - 1);
    EXPECT_NEAR(std::exp(-z / w * time), e, 1e-4);
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
  double twist = 0;
  const auto c = contact(1e-5, {0, 0, 0});
  const auto f = contact_force<HertzMindlin>(c, kPair, false, 1e-4, slip);
  D rolling, patch;
  for (int n = 0; n < 1000; ++n) {
    rolling = rolling_moment(c, kPair, f, D{10, 0, 3}, 1e-4, roll);
    patch = patch_moment(1e-3, c.normal, kPair, f, D{10, 0, 3}, 1e-4, twist);
  }
  EXPECT_NEAR(rolling.x, -0.1 * 2e-3 * f.normal, 1e-15);
  EXPECT_EQ(rolling.z, 0.0);
  EXPECT_NEAR(patch.z, -2.0 / 3.0 * 0.4 * f.normal * 1e-3, 1e-15);
  EXPECT_NEAR(patch.x, -std::min(f.normal * 1e-3, 0.25e-6 * f.dashpot * 10), 1e-15);
}

}  // namespace
}  // namespace ejecta
