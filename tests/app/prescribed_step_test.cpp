#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/clock.hpp"
#include "case/load.hpp"
#include "simulation/coupled_model.hpp"

using namespace ejecta;

/// Bodies that follow a formula in a fluid.
namespace {

constexpr double kPeriod = 2 * std::numbers::pi / 400;

/// A box of air at rest around a cube that swings by 1 mm.
Case still_air(const std::string& velocity) {
  return parse_case(
      "[run]\nend_time = \"40 ms\"\n[flow]\nsolver = \"incompressible\"\n"
      "[grid.x]\npoints = [\"-24 mm\", \"24 mm\"]\ncells = [24]\n"
      "[grid.y]\npoints = [\"-16 mm\", \"16 mm\"]\ncells = [16]\n"
      "[grid.z]\npoints = [\"-16 mm\", \"16 mm\"]\ncells = [16]\n"
      "[[body]]\nshape = \"box\"\nsize = [\"10 mm\", \"10 mm\", \"10 mm\"]\nmotion = \"prescribed\"\n"
      "velocity = [\"" +
          velocity + "\", \"0 m/s\", \"0 m/s\"]\n",
      "still air");
}

/// Nothing moves at the start: without a look ahead the first step would be the whole run.
TEST(PrescribedStep, ASwingFromRestInStillAirIsResolved) {
  CoupledModel model(still_air("= 0.4 * sin(400 * t)"));
  EXPECT_LT(model.stable_dt(0.0), kPeriod / 40);
  EXPECT_GT(model.stable_dt(0.0), kPeriod / 1000) << "but not absurdly";
}

/// The air is pushed one way and the other; after whole periods the body is where it was, to the last digits.
TEST(PrescribedStep, AfterWholePeriodsTheBodyIsBackAndTheAirHasPushedBothWays) {
  CoupledModel model(still_air("= 0.4 * sin(400 * t)"));
  double least = 0.0, most = 0.0, farthest = 0.0;
  for (double t = 0.0; t < 2 * kPeriod * (1 - 1e-12);) {
    const double dt = std::min(model.stable_dt(t), 2 * kPeriod - t);
    model.advance(t, dt);
    t += dt;
    if (t > kPeriod) {
      least = std::min(least, model.loads()[0].force.x());
      most = std::max(most, model.loads()[0].force.x());
    }
    farthest = std::max(farthest, model.particles().bodies()[0].position.x());
  }
  EXPECT_NEAR(model.particles().bodies()[0].position.x(), 0.0, 1e-14);
  EXPECT_NEAR(farthest, 2e-3, 1e-5);
  EXPECT_GT(most, 0.0);
  EXPECT_LT(least, 0.0);
  EXPECT_NEAR(most / -least, 1.0, 0.4);
}

}  // namespace
