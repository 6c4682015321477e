#include "sorter/launch.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "jet/inflow.hpp"
#include "sorter/splitter.hpp"

namespace ejecta {
namespace {

const Vec3 kGravity(0, 0, -9.81);

TEST(Launch, CrossesTheAxisAtTheGivenHeightAndTimeWithTheFallFromTheBelt) {
  LaunchSpec l;
  l.belt_speed = 3.0, l.drop_distance = 0.12, l.stand_off = 0.075, l.arrives_at = 5e-3, l.offset_along = 2e-3;
  const FlightState s = launch_state(l, Vec3::Zero(), kGravity, 5e-3);
  EXPECT_NEAR(s.position.x(), 2e-3, 1e-15);
  EXPECT_NEAR(s.position.z(), 0.075, 1e-15);
  EXPECT_NEAR(s.velocity.z(), -9.81 * 0.04, 1e-12);
  const FlightState left = launch_state(l, Vec3::Zero(), kGravity, 5e-3 - 0.04);
  EXPECT_NEAR(left.velocity.z(), 0.0, 1e-12);  // horizontal as it leaves the belt
}

TEST(Splitter, DecidesByTheHeightAtTheEdge) {
  SplitterSpec spec;
  spec.distance = 0.25, spec.height = 0.04;
  for (double gain : {0.3, 0.7}) {
    Splitter splitter(spec, Vec3::Zero(), 0.0, 0.0);
    splitter.resize(1);
    Body b{.name = "b", .shape = make_sphere(0.01)};
    b.velocity = Vec3(3, 0, gain);
    double time = 0.0;
    const double dt = 1e-4;
    while (!splitter.all_passed()) {
      const std::vector<Vec3> before{b.position};
      b.position += dt * b.velocity;
      time += dt;
      splitter.watch(std::vector<Body>{b}, before, time, dt);
    }
    const Verdict& v = *splitter.verdict(0);
    EXPECT_NEAR(v.clearance, 0.25 / 3.0 * gain - 0.04, 1e-9);
    EXPECT_NEAR(v.velocity_margin, gain - 0.04 * 3.0 / 0.25, 1e-9);
    EXPECT_EQ(v.ejected, gain > 0.48);
  }
}

TEST(Splitter, ABodyThrownBackBelowTheEdgeIsNotEjected) {
  SplitterSpec spec;
  spec.distance = 0.25, spec.height = 0.04;
  Splitter splitter(spec, Vec3::Zero(), 0.0, 0.0);
  splitter.resize(1);
  Body b{.name = "b", .shape = make_sphere(0.01)};
  b.velocity = Vec3(3, 0, 0.24);
  double time = 0.0;
  const double dt = 1e-4;
  while (!splitter.all_passed() && time < 1.0) {
    const std::vector<Vec3> before{b.position};
    if (b.position.x() > 0.245) b.velocity.x() = -1.0;  // what the plate does
    b.position += dt * b.velocity;
    time += dt;
    splitter.watch(std::vector<Body>{b}, before, time, dt);
  }
  ASSERT_TRUE(splitter.all_passed());
  EXPECT_FALSE(splitter.verdict(0)->ejected);
  EXPECT_NEAR(splitter.verdict(0)->clearance, 0.25 * 0.08 - 0.04, 1e-9);  // of the flight it was kept from
  EXPECT_NEAR(splitter.verdict(0)->velocity_margin, 0.24 - 0.48, 1e-9);
}

/// One that bounces off the plate's edge, up and away from it, and falls: over the plate it never comes.
TEST(Splitter, ABodyThatBouncesUpAndBackIsNotEjected) {
  SplitterSpec spec;
  spec.edge = {0.25, 0.0};
  Splitter plate(spec, Vec3(0, 0, 0), 0.0, -9.81);
  Body ball{.name = "ball", .shape = make_sphere(0.01)};
  ball.position = Vec3(0.23, 0, 0.001);
  plate.resize(1);
  const auto step = [&](const Vec3& to, const Vec3& v) {
    const Vec3 before = ball.position;
    ball.position = to;
    ball.velocity = v;
    plate.watch(std::span(&ball, 1), std::span(&before, 1), 0.1, 1e-3);
  };
  step(Vec3(0.235, 0, 0.001), Vec3(3, 0, 0));
  step(Vec3(0.245, 0, 0.001), Vec3(3, 0, 0));
  step(Vec3(0.246, 0, 0.02), Vec3(-0.3, 0, 0.2));
  EXPECT_FALSE(plate.verdict(0));
  step(Vec3(0.15, 0, -0.1), Vec3(-0.3, 0, -2));
  ASSERT_TRUE(plate.verdict(0));
  EXPECT_FALSE(plate.verdict(0)->ejected);
  EXPECT_TRUE(plate.verdict(0)->thrown_back);
  EXPECT_LT(plate.verdict(0)->clearance, 0.0);
}

TEST(SelfSimilarJet, CarriesTheThrustOfTheValve) {
  JetSpec jet;
  ValveSpec valve;
  const SelfSimilarJet j(jet, valve, 1.0);
  const double u0 = 880.0, z = 0.04;
  double momentum = 0.0, volume = 0.0;
  const double dr = 1e-5;
  for (double r = 0.5 * dr; r < 0.5; r += dr) {
    const InflowState s = j.at(Vec3(r, 0, z), u0);
    momentum += s.velocity.z() * s.velocity.z() * 2 * 3.14159265358979 * r * dr;
    volume += s.velocity.z() * 2 * 3.14159265358979 * r * dr;
  }
  const double area = 3.14159265358979 / 4 * valve.orifice_diameter * valve.orifice_diameter;
  EXPECT_NEAR(momentum / (area * u0 * u0), 1.0, 1e-3);
  EXPECT_NEAR(j.decay() * jet.spreading, 0.557, 1e-3);  // reference-data A1
  EXPECT_GT(volume, 5.0 * area * u0);                   // entrained air
}

TEST(SelfSimilarJet, IsFreeOfDivergence) {
  const SelfSimilarJet j(JetSpec{}, ValveSpec{}, 1.0);
  const auto u = [&](double r, double z) { return j.at(Vec3(r, 0, z), 880.0).velocity; };
  const double h = 1e-6;
  for (double r : {1e-3, 4e-3, 9e-3}) {
    const double z = 0.05;
    const double radial = ((r + h) * u(r + h, z).x() - (r - h) * u(r - h, z).x()) / (2 * h * r);
    const double axial = (u(r, z + h).z() - u(r, z - h).z()) / (2 * h);
    EXPECT_NEAR((radial + axial) / std::abs(axial), 0.0, 1e-4);
  }
}

}  // namespace
}  // namespace ejecta
