#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "flow/godunov/flux_wall.hpp"
#include "godunov_case.hpp"
#include "godunov_riemann.hpp"

namespace ejecta {
namespace {

using gas::GasState;
using test::even_axis;
using test::ExactRiemann;
using test::make_tube;
using test::Tube;

TEST(GodunovWall, TakesThePressureOfItsCellUpToTheSpeedItsEnergyCanPayFor) {
  const gas::GasConstants gas(1.4, 287.05, 0.0);
  const double c = std::sqrt(1.4), most = std::sqrt(2 / (1.4 * 0.4));
  for (const double mach : {-1.8, -0.5, 0.0, 0.01, 1.0, 1.8})
    EXPECT_EQ(wall_pressure(gas, 1, Real(mach * c), 1), 1);
  for (const double mach : {2.0, 3.0}) {
    EXPECT_NEAR(wall_pressure(gas, 1, Real(mach * c), 1), 1 - 1.4 * (mach - most), 1e-5);
    EXPECT_GT(wall_pressure(gas, 1, Real(-mach * c), 1), 1 + 1.4 * (mach - most));
  }
}

class WallAndGas : public testing::TestWithParam<double> {};

// Gas that runs against a wall, or away from it, at a Mach number: the pressure at the wall becomes that of
// the Riemann problem with its mirror image.
TEST_P(WallAndGas, PressureOfTheWallIsExact) {
  const double mach = GetParam(), c = std::sqrt(1.4);
  const int cells = 200;
  for (const bool upper : {false, true}) {
    auto t = make_tube(0, cells);
    const GasState gas{1.0, {(upper ? -mach : mach) * c, 0, 0}, 1.0};
    t->all_boundaries(BoundaryType::symmetry);
    t->boundary(upper ? 1 : 0, BoundaryType::wall);
    t->boundary(upper ? 0 : 1, BoundaryType::wave_transmissive, gas);
    t->fill([&](const Vec3&) { return gas; });
    t->run(0.25 / (c * (1.0 + std::max(mach, 0.0))), 0.9);
    const double exact = ExactRiemann({1.0, -mach * c, 1.0}, {1.0, mach * c, 1.0}).pressure();
    double pressure = 0.0;  // a shock that hardly moves leaves waves behind it: mean of ten cells
    for (int n = 0; n < 10; ++n) pressure += 0.1 * t->solver.at(upper ? cells - 1 - n : n, 0, 0).pressure;
    const GasState wall = t->solver.at(upper ? cells - 1 : 0, 0, 0);
    EXPECT_NEAR(pressure / exact, 1.0, 0.02);
    EXPECT_NEAR(wall.velocity.x(), 0.0, 0.01 * c);
  }
}

INSTANTIATE_TEST_SUITE_P(Mach, WallAndGas, testing::Values(-10.0, -3.0, -1.0, -0.3, 0.1, 0.5, 1.0, 1.5));

// From Mach 5 on the exact answer is vacuum.
TEST(GodunovWall, GasThatLeavesAWallFasterThanSoundStaysPositive) {
  for (const double mach : {2.0, 3.0, 10.0}) {
    auto t = make_tube(0, 200);
    const GasState gas{1.0, {mach * std::sqrt(1.4), 0, 0}, 1.0};
    t->all_boundaries(BoundaryType::symmetry);
    t->boundary(0, BoundaryType::wall);
    t->boundary(1, BoundaryType::wave_transmissive, gas);
    t->fill([&](const Vec3&) { return gas; });
    t->run(0.25 / (1.0 + mach), 0.9);
    for (int n = 0; n < 200; ++n) {
      ASSERT_GT(t->solver.at(n, 0, 0).density, 0.0) << mach;
      ASSERT_GT(t->solver.at(n, 0, 0).pressure, 0.0) << mach;
    }
  }
}

// Without viscosity a wall that sticks holds nothing: a strong shock runs along it as along a symmetry plane.
TEST(GodunovWall, AGasWithoutViscositySlidesAlongAWallThatSticks) {
  const auto shock_tube = [](BoundaryType sides) {
    Tube t(even_axis(0, 1, 100), even_axis(0, 1, 1), even_axis(0, 0.04, 4), false, {});
    t.all_boundaries(BoundaryType::symmetry);
    t.boundary(4, sides);
    t.boundary(5, sides);
    t.fill([](const Vec3& x) { return GasState{1.0, {0, 0, 0}, x.x() < 0.5 ? 1000.0 : 0.01}; });
    t.run(0.01, 0.5);
    std::vector<double> along;
    for (int k = 0; k < 4; ++k)
      for (int i = 0; i < 100; ++i) along.push_back(t.solver.at(i, 0, k).velocity.x());
    return along;
  };
  const std::vector<double> free = shock_tube(BoundaryType::symmetry), stuck = shock_tube(BoundaryType::wall);
  for (std::size_t n = 0; n < free.size(); ++n) EXPECT_NEAR(stuck[n], free[n], 1e-4 * 19.6) << n;
}

}  // namespace
}  // namespace ejecta
