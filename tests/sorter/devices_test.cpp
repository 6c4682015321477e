#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "case/load.hpp"
#include "sorter/air_vessel.hpp"
#include "sorter/camera.hpp"
#include "sorter/controller.hpp"
#include "sorter/feed.hpp"
#include "sorter/flight.hpp"
#include "sorter/manifold.hpp"

using namespace ejecta;

/// Each device of a sorter by itself: plain data in, plain data out.
namespace {

Case tutorial_sorter() { return load_case(EJECTA_SOURCE_DIR "/cases/sorter/tutorial.toml"); }

ParticleClassSpec cubes(SizeLaw law, double size) {
  ParticleClassSpec k;
  k.name = "cubes";
  k.share = 1.0;
  k.sizes = law;
  k.size = size;
  return k;
}

TEST(ParticleClass, OfLognormalSizesHasTheThirdMomentOfTheLaw) {
  ParticleClassSpec k = cubes(SizeLaw::lognormal, 10e-3);
  k.spread = 0.2;
  const ParticleClass made(k, "", 1);
  const double law = 2700.0 * 1e-6 * std::exp(4.5 * 0.2 * 0.2);
  EXPECT_NEAR(made.mean_mass(), law, 2e-3 * law);
  EXPECT_NEAR(made.size_at(0.5), 10e-3, 1e-9);
}

TEST(ParticleClass, OfSievesHasTheirSharesOfTheMass) {
  ParticleClassSpec k = cubes(SizeLaw::sieves, 0.0);
  k.sieves = "sieves.csv";  // 8 mm: 0, 10 mm: 0.4, 12.5 mm: 1
  const ParticleClass made(k, EJECTA_SOURCE_DIR "/tests/good_cases", 1);
  double below = 0.0, all = 0.0;
  constexpr int kDraws = 20000;
  for (int n = 0; n < kDraws; ++n) {
    const double size = made.size_at((n + 0.5) / kDraws), mass = size * size * size;
    all += mass;
    if (size < 10e-3) below += mass;
  }
  EXPECT_NEAR(below / all, 0.4, 2e-3);
  k.sieves = EJECTA_SOURCE_DIR "/tests/good_cases/sieves.csv";  // as in a resolved case
  EXPECT_EQ(ParticleClass(k, "/another/folder", 1).mean_mass(), made.mean_mass());
}

TEST(ParticleClass, OfRosinAndRammlerHasItsMassMedian) {
  ParticleClassSpec k = cubes(SizeLaw::rosin_rammler, 10e-3);
  k.spread = 3.0;
  const ParticleClass made(k, "", 1);
  const double median = 10e-3 * std::pow(std::numbers::ln2, 1.0 / 3.0);  // half of the mass is finer
  double below = 0.0, all = 0.0;
  constexpr int kDraws = 20000;
  for (int n = 0; n < kDraws; ++n) {
    const double size = made.size_at((n + 0.5) / kDraws), mass = size * size * size;
    all += mass;
    if (size < median) below += mass;
  }
  EXPECT_NEAR(below / all, 0.5, 5e-3);
}

TEST(Camera, JoinsWhatLiesNearerThanTheGapAndReadsTheMean) {
  Case c = tutorial_sorter();
  c.camera.gap = 2e-3;
  c.camera.noise = 0.0;
  const ParticleClass made(cubes(SizeLaw::one, 10e-3), "", 1);
  const Camera camera(c);
  for (const auto& [apart, objects] : {std::pair{1.5e-3, 1u}, std::pair{2.6e-3, 2u}})
    for (const bool along : {true, false}) {
      std::vector<FeedParticle> pair(2);
      for (FeedParticle& p : pair) {
        p.prototype = &made.prototype(0.5);
        p.x = 0.1;
      }
      (along ? pair[1].x : pair[1].y) += 10e-3 + apart;
      pair[1].signal = 1.0;
      const std::vector<SeenObject> seen = camera.look(pair);
      ASSERT_EQ(seen.size(), objects) << apart << along;
      double pixels = 0.0, signal = 0.0;
      for (const SeenObject& o : seen) {
        pixels += static_cast<double>(o.pixels);
        signal += static_cast<double>(o.pixels) * o.signal;
      }
      EXPECT_NEAR(pixels * camera.pixel() * camera.pixel(), 2e-4, 0.06 * 2e-4);
      EXPECT_NEAR(signal / pixels, 0.5, 0.03);
    }
}

SeenObject seen_at(double x, double y, double length, double width) {
  SeenObject o;
  o.x_low = x - 0.5 * length;
  o.x_high = x + 0.5 * length;
  o.y_low = y - 0.5 * width;
  o.y_high = y + 0.5 * width;
  o.eject = true;
  return o;
}

TEST(Controller, OpensTheWindowOfItsRule) {
  Case c = tutorial_sorter();
  const std::vector<SeenObject> objects{seen_at(0.3, 0.0, 12e-3, 10e-3)};
  const ValveCommand fixed = Controller(c).commands(objects).at(0);
  EXPECT_NEAR(fixed.from, 0.1 - c.controller.lead, 0.5 * c.controller.step + 1e-12);
  EXPECT_NEAR(fixed.from / c.controller.step, std::round(fixed.from / c.controller.step), 1e-9);
  EXPECT_NEAR(fixed.to - fixed.from, 8e-3, 1e-12);
  EXPECT_EQ(fixed.last - fixed.first + 1, std::ceil(10e-3 / valve_pitch(c)));
  EXPECT_LT(std::abs(0.5 * (valve_place(c, fixed.first) + valve_place(c, fixed.last))),
            0.5 * valve_pitch(c) + 1e-12);

  c.controller = {.window = WindowRule::by_size,
                  .step = 0.0,
                  .lead = 2e-3,
                  .quantile = 3.0,
                  .time_error = 0.4e-3,
                  .place_error = 0.5e-3};
  const ValveCommand by_size = Controller(c).commands(objects).at(0);
  EXPECT_NEAR(by_size.from, 0.1 - 2e-3 - 3.0 * 0.4e-3 - 2e-3, 1e-12);  // front, errors, lead
  EXPECT_NEAR(by_size.to - by_size.from, 4e-3 + 2.0 * 3.0 * 0.4e-3, 1e-12);
  EXPECT_EQ(by_size.last - by_size.first + 1, std::ceil((10e-3 + 2.0 * 3.0 * 0.5e-3) / valve_pitch(c)));
}

TEST(Manifold, MergesCommandsAndLeavesDeadValvesShut) {
  Case c = tutorial_sorter();
  c.controller.shortest_off = 1e-3;
  c.manifold.dead_valves = {4};
  const std::vector<ValveCommand> commands{
      {0, 3, 4, 0.000, 0.008}, {1, 3, 3, 0.006, 0.014}, {2, 3, 3, 0.0145, 0.020}, {3, 3, 3, 0.030, 0.038}};
  const auto pulses = Manifold(c).pulses(commands);
  ASSERT_EQ(pulses[3].size(), 2u);
  EXPECT_EQ(pulses[3][0].from, 0.000);
  EXPECT_EQ(pulses[3][0].to, 0.020);
  EXPECT_EQ(pulses[3][1].from, 0.030);
  EXPECT_TRUE(pulses[4].empty());
  EXPECT_EQ(Manifold(c).pulses(commands, true)[4].size(), 1u);
}

TEST(AirVessel, FallsByWhatValvesTakeAndNotWhereItIsLarge) {
  Case c = tutorial_sorter();
  std::vector<std::vector<ValvePulse>> pulses(2);
  pulses[0] = {{.from = 0.0, .to = 8e-3}};
  pulses[1] = {{.from = 8e-3, .to = 16e-3}};
  c.manifold.line_diameter = 1e-6;  // brings nothing
  c.manifold.vessel = 1e3;
  auto large = pulses;
  AirVessel(c).draw(large, 0.0, AirVessel(c).full());
  EXPECT_NEAR(large[1][0].strength, 1.0, 1e-5);
  c.manifold.vessel = 1e-3;
  auto small = pulses;
  AirVessel(c).draw(small, 0.0, AirVessel(c).full());
  // dp/dt = -(R T/V) m', m' in proportion to p: p falls by exp(-t/T), and each opening of 8 ms sees its mean.
  const double decay = std::log(small[0][0].use / small[1][0].use);
  const double temperature = c.environment.temperature, gas = c.fluid.gas_constant;
  const double flow = 0.25 * std::numbers::pi * 1.8e-3 * 1.8e-3 * std::sqrt(1.4 / (gas * temperature)) *
                      std::pow(2.0 / 2.4, 3.0);  // choked, kg/s per Pa
  EXPECT_NEAR(decay, 8e-3 * gas * temperature / 1e-3 * flow, 0.05 * decay);
  EXPECT_LT(small[1][0].strength, small[0][0].strength);
  // In two parts as in one.
  const AirVessel vessel(c);
  const double half = vessel.after(pulses, 0.0, 8e-3, vessel.full()),
               whole = vessel.after(pulses, 0.0, 16e-3, vessel.full());
  EXPECT_LT(half, vessel.full());
  EXPECT_NEAR(vessel.after(pulses, 8e-3, 16e-3, half), whole, 1e-9 * whole);
}

TEST(Feed, FromAFileIsWhatTheFileSays) {
  const Case c = load_case(EJECTA_SOURCE_DIR "/tests/good_cases/machine.toml");
  const Feed feed(c);
  const std::vector<FeedParticle> list = feed.cells(0, feed.cells_of_file());
  ASSERT_EQ(list.size(), 3u);
  EXPECT_NEAR(list[1].x, 40e-3, 1e-12);
  EXPECT_NEAR(list[2].y, 110e-3, 1e-12);
  EXPECT_NEAR(list[1].size(), 12e-3, 1e-12);
  EXPECT_EQ(list[2].kind, 1);
}

TEST(FastFlight, WithoutAirIsTheFreeFlightAndWithItGoesUpEvenly) {
  const Case c = tutorial_sorter();
  const auto source = make_jet_source(c);
  const JetField field(c, *source);
  const FastFlight flight(c, field);
  const ParticleClass made(cubes(SizeLaw::one, 10e-3), "", 1);
  FeedParticle p;
  p.prototype = &made.prototype(0.5);
  p.mass = made.mass_of(*p.prototype, 1.0);
  const FlightEnd free = flight.fly({.particle = &p, .at = 0.0, .y = 0.0});
  EXPECT_NEAR(free.clearance, -c.splitter.height, 1e-12);
  EXPECT_EQ(free.gain, 0.0);
  const Blow blow{0.0, {.from = -6e-3, .to = 2e-3}};
  const FlightEnd left = flight.fly({.particle = &p, .at = 0.0, .y = 3e-3, .blows = {blow}}),
                  right = flight.fly({.particle = &p, .at = 0.0, .y = -3e-3, .blows = {blow}});
  EXPECT_GT(left.gain, 0.1);
  EXPECT_NEAR(left.gain, right.gain, 1e-9);
  EXPECT_NEAR(left.y, -right.y, 1e-9);
}

}  // namespace
