#include "flow/turbulence/sources.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "flow/stencil.hpp"

namespace ejecta {
namespace {

/// Strain times turbulent time, S k / epsilon, after 5 ms of homogeneous shear at the rate S.
double settled_time(double stretching) {
  const double strain = 8000.0, dt = 5e-6;  // 1/s, s
  double k = 100.0, epsilon = 1e5;          // m2/s2, m2/s3
  for (int n = 0; n < 1000; ++n) {
    SourcePoint p{};
    p.k = p.k_carried = static_cast<Real>(k);
    p.dissipation = p.dissipation_carried = static_cast<Real>(epsilon);
    p.strain2 = static_cast<Real>(strain * strain);
    p.eddy_viscosity = static_cast<Real>(0.09 * k * k / epsilon);
    p.produced = p.eddy_viscosity * p.strain2;
    p.stretching = static_cast<Real>(stretching);
    const SourceResult r = advance_sources<false, true>(p, static_cast<Real>(dt));
    k = double(r.k);
    epsilon = double(r.dissipation);
  }
  return strain * k / epsilon;
}

TEST(KEpsilon, SettlesInHomogeneousShearWherePopesTermIsZeroOrASink) {
  // k / epsilon stands still where production is (C2 - 1) / (C1 - 1) times dissipation.
  const double exact = std::sqrt((1.92 - 1.0) / (1.44 - 1.0) / 0.09);
  EXPECT_NEAR(settled_time(0.0), exact, 0.02 * exact);
  // The wake of a body compresses vortices: the dissipation would vanish within a millisecond.
  for (const double compression : {1e9, 1e10, 1e11})
    EXPECT_NEAR(settled_time(-compression), exact, 0.02 * exact) << compression;
}

TEST(KEpsilon, LivesShorterWhereVorticesAreStretched) {
  double before = settled_time(0.0);
  for (const double stretching : {1e9, 1e10, 1e11}) {  // 1/s3
    const double now = settled_time(stretching);
    EXPECT_LT(now, 0.99 * before) << stretching;
    before = now;
  }
}

TEST(PositiveSum, IsTheSumUntilHalfIsGoneAndNeverReachesZero) {
  for (const double before : {1e-3, 1.0, 4e7}) {
    double last = 4.01 * before;
    for (double change = 3.0; change > -1000.0; change -= 0.01) {
      const double sum = double(positive_sum(Real(before), Real(change * before)));
      EXPECT_GT(sum, 0.0);
      EXPECT_LE(sum, last * (1 + 1e-6)) << change;                     // the more is taken, the less is left
      EXPECT_GE(sum, last - 0.0101 * before - 1e-6 * last) << change;  // without a step
      if (change >= -0.5) {
        EXPECT_NEAR(sum, before * (1 + change), 1e-6 * before * (1 + std::abs(change)));
      }
      last = sum;
    }
  }
}

}  // namespace
}  // namespace ejecta
