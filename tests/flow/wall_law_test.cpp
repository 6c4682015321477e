#include "flow/turbulence/wall_law.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace ejecta {
namespace {

constexpr double kGas = 1.5e-5;  // m2/s
const std::array<double, 5> kSpeeds{0.01, 0.3, 3.0, 30.0, 120.0}, kDistances{1e-5, 1e-4, 1e-3, 3e-3, 2e-2};

TEST(WallLaw, TheLayerMeetsTheLogarithmWithoutAStep) {
  EXPECT_EQ(wall_law::u_plus(Real(5), 0), Real(5));
  for (const double sand : {0.0, 3.0, 30.0, 1000.0}) {
    double before = 0.0;
    for (double y = 0.1; y < 1e4; y *= 1.02) {
      const double u = wall_law::u_plus(Real(y), Real(sand));
      EXPECT_GE(u, before) << y;
      EXPECT_LT(u, before + 0.025 * y + 0.06 + (before == 0.0)) << y << " " << sand;
      before = u;
    }
  }
}

TEST(WallLaw, IsTheLogarithmOfExperimentsFarFromASmoothWall) {
  for (const double y : {50.0, 300.0, 2000.0})
    EXPECT_NEAR(wall_law::u_plus(Real(y), 0), std::log(y) / 0.41 + 5.5, 0.1);  // Nikuradse 1932
}

TEST(WallLaw, AFullyRoughWallIsNikuradses) {
  for (const double sand : {150.0, 500.0, 3000.0})
    for (const double heights : {1.5, 5.0, 40.0}) {
      const double u = wall_law::u_plus(Real(heights * sand), Real(sand)),
                   rough = std::log(heights) / 0.41 + 8.5;
      EXPECT_NEAR(u / rough, 1.0, 0.05) << sand << " " << heights;
    }
}

TEST(WallLaw, RoughnessOnlyAddsFriction) {
  for (const double u : kSpeeds)
    for (const double y : kDistances) {
      double before = 0.0;
      for (const double sand : {0.0, 0.01, 0.1, 0.5}) {
        const double tau = wall_law::friction_velocity(Real(u), Real(y), Real(kGas), Real(sand * y));
        EXPECT_GE(tau, before * (1 - 1e-3)) << u << " " << y << " " << sand;
        before = tau;
      }
    }
}

TEST(WallLaw, FrictionVelocityInvertsTheLaw) {
  for (const double u : kSpeeds)
    for (const double y : kDistances)
      for (const double sand : {0.0, 0.02, 0.3}) {
        const double tau = wall_law::friction_velocity(Real(u), Real(y), Real(kGas), Real(sand * y));
        const double y_plus = tau * y / kGas;
        EXPECT_NEAR(tau * double(wall_law::u_plus(Real(y_plus), Real(sand * y_plus))) / u, 1.0, 0.01)
            << u << " " << y << " " << sand << " y+ " << y_plus;
      }
}

TEST(WallLaw, TheWallNeverRubsLessThanALaminarLayer) {
  for (const double u : kSpeeds)
    for (const double y : kDistances)
      for (const double k : {0.0, 1e-6, 1e-2, 10.0, 500.0})
        for (const double sand : {0.0, 0.1}) {
          const double rubs = wall_law::conductance(Real(u), Real(y), Real(kGas), Real(k), Real(sand * y));
          EXPECT_GE(rubs, kGas / y * (1 - 1e-6)) << u << " " << y << " " << k;
          EXPECT_TRUE(std::isfinite(rubs));
        }
  EXPECT_FLOAT_EQ(float(wall_law::conductance(0, Real(1e-3), Real(kGas), 0, 0)), float(kGas / 1e-3));
}

TEST(WallLaw, TurbulenceInEquilibriumGivesTheFrictionOfTheMeanFlow) {
  const double y = 2e-3, tau = 3.0, k = tau * tau / 0.3;  // C_mu^(1/2) k = u_tau^2
  const double u = tau * double(wall_law::u_plus(Real(tau * y / kGas), 0));
  EXPECT_NEAR(wall_law::conductance(Real(u), Real(y), Real(kGas), Real(k), 0) * u / (tau * tau), 1.0, 1e-3);
  EXPECT_NEAR(wall_law::dissipation(Real(k), Real(y), Real(kGas)) * 0.41 * y / std::pow(tau, 3), 1.0, 1e-3);
}

}  // namespace
}  // namespace ejecta
