#include "jet/valve.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>

#include "base/error.hpp"

namespace ejecta {
namespace {

ValveSpec pulse(ValveShape shape) {
  ValveSpec spec;
  spec.shape = shape;
  spec.opens_at = 1e-3;
  spec.delay = 0.5e-3;
  spec.rise_time = 4e-3;
  spec.duration = 8e-3;
  spec.fall_time = 2e-3;
  return spec;
}

std::string trace_file(const std::string& name, const std::string& text) {
  const auto path = std::filesystem::temp_directory_path() / ("ejecta_" + name + ".csv");
  std::ofstream(path) << text;
  return path.string();
}

Valve traced(const std::string& name, const std::string& text) {
  ValveSpec spec = pulse(ValveShape::trace);
  spec.trace = trace_file(name, text);
  return Valve(spec);
}

std::string refusal(const std::function<void()>& build) {
  try {
    build();
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(Valve, LinearRisesHoldsAndFalls) {
  const Valve valve(pulse(ValveShape::linear));
  EXPECT_EQ(valve.opening(0.0), 0.0);
  EXPECT_EQ(valve.opening(1.5e-3), 0.0);
  EXPECT_NEAR(valve.opening(3.5e-3), 0.5, 1e-12);
  EXPECT_EQ(valve.opening(6e-3), 1.0);
  EXPECT_NEAR(valve.opening(10.5e-3), 0.5, 1e-12);
  EXPECT_NEAR(valve.opening(11.6e-3), 0.0, 1e-12);
  EXPECT_NEAR(valve.closed_from(), 11.5e-3, 1e-15);
}

TEST(Valve, SmoothHasNoKink) {
  const Valve valve(pulse(ValveShape::smooth));
  EXPECT_NEAR(valve.opening(3.5e-3), 0.5, 1e-12);
  for (const double t : {1.5e-3, 5.5e-3, 9.5e-3, 11.5e-3})
    EXPECT_NEAR(valve.opening(t + 1e-6), valve.opening(t - 1e-6), 1e-5) << t;
}

TEST(Valve, ExponentialReaches95PercentInARiseTime) {
  const Valve valve(pulse(ValveShape::exponential));
  EXPECT_NEAR(valve.opening(5.5e-3), 1.0 - std::exp(-3.0), 1e-12);
  EXPECT_LE(valve.opening(valve.closed_from()), 1e-3);
}

TEST(Valve, ClosesFromWhereverItStood) {
  ValveSpec spec = pulse(ValveShape::linear);
  spec.duration = 2e-3;  // half way up
  const Valve valve(spec);
  EXPECT_NEAR(valve.opening(3.5e-3), 0.5, 1e-12);
  EXPECT_NEAR(valve.opening(4.5e-3), 0.25, 1e-12);
}

TEST(Valve, ZeroRiseAndFallAreSteps) {
  ValveSpec spec = pulse(ValveShape::smooth);
  spec.rise_time = spec.fall_time = 0.0;
  const Valve valve(spec);
  EXPECT_EQ(valve.opening(1.5e-3), 0.0);
  EXPECT_EQ(valve.opening(1.5e-3 + 1e-9), 1.0);
  EXPECT_EQ(valve.opening(9.5e-3), 1.0);
  EXPECT_EQ(valve.opening(9.5e-3 + 1e-9), 0.0);
}

TEST(Valve, MorePulsesRepeatTheFirst) {
  ValveSpec spec = pulse(ValveShape::smooth);
  spec.more_pulses = {21e-3};
  const Valve valve(spec);
  EXPECT_NEAR(valve.opening(24e-3), valve.opening(4e-3), 1e-12);
  EXPECT_EQ(valve.opening(15e-3), 0.0);
  EXPECT_EQ(valve.events().size(), 8u);
  EXPECT_TRUE(std::is_sorted(valve.events().begin(), valve.events().end()));
}

TEST(Valve, TotalPressureGoesFromAmbientToSupply) {
  const Valve valve(pulse(ValveShape::smooth));
  EXPECT_DOUBLE_EQ(valve.total_pressure(0.0, 101325.0), 101325.0);
  EXPECT_DOUBLE_EQ(valve.total_pressure(7e-3, 101325.0), 801325.0);
}

TEST(Valve, TraceIsInterpolatedAndClosedOutside) {
  const Valve valve = traced("good", "time [s],opening [1]\n# measured\n0,0\n0.002,1\n0.008,1\n0.009,0\n");
  EXPECT_NEAR(valve.opening(1.5e-3 + 1e-3), 0.5, 1e-12);
  EXPECT_NEAR(valve.opening(1.5e-3 + 8.5e-3), 0.5, 1e-9);
  EXPECT_EQ(valve.opening(20e-3), 0.0);
}

/// The same opening, as recorders and spreadsheets write it.
TEST(Valve, ATraceIsReadInTheUnitsOfItsHead) {
  using testing::HasSubstr;
  for (const char* text : {"0,0\n0.002,1\n0.006,1\n0.008,0\n", "time [ms],opening [1]\n0,0\n2,1\n6,1\n8,0\n",
                           "time (ms), opening (%)\n0, 0\n2, 100\n6, 100\n8, 0\n",
                           "\xEF\xBB\xBFZeit [ms];Weg [%]\r\n0,0;0\r\n2,0;100,0\r\n6,0;100,0\r\n8,0;0\r\n",
                           "t / us\topening\n0\t0\n2000\t1\n6000\t1\n8000\t0\n",
                           "\"t [\u00b5s]\",\"opening\"\n0,0\n2e3,1\n6e3,1\n8e3,0\n"}) {
    const Valve valve = traced("units", text);
    for (const double ms : {0.5, 1.0, 4.0, 7.5})
      EXPECT_NEAR(valve.opening(1.5e-3 + ms * 1e-3),
                  ms < 2.0   ? ms / 2.0
                  : ms > 6.0 ? (8.0 - ms) / 2.0
                             : 1.0,
                  1e-9)
          << ms << " ms of\n"
          << text;
  }
  EXPECT_THAT(refusal([] { traced("bare", "time,opening\n0,0\n2,1\n"); }),
              HasSubstr("bare.csv:1: error: the column \"time\" has no unit"));
  EXPECT_THAT(refusal([] { traced("metres", "time [mm],opening\n0,0\n2,1\n"); }),
              HasSubstr("\"mm\" is no unit of a time"));
  EXPECT_THAT(refusal([] { traced("comma", "time [ms],opening\n0,5,0,1\n2,5,1,0\n"); }),
              HasSubstr("comma.csv:2: error: 4 values for 2 columns"));
}

TEST(Valve, RefusesBadTraces) {
  using testing::HasSubstr;
  EXPECT_THAT(refusal([] { traced("disorder", "0,0\n0.002,1\n0.001,0\n"); }), HasSubstr("does not increase"));
  EXPECT_THAT(refusal([] { traced("missing", "0,0\n0.002,\n0.003,0\n"); }), HasSubstr("missing.csv:2"));
  EXPECT_THAT(refusal([] { traced("range", "0,0\n0.002,1.2\n0.003,0\n"); }), HasSubstr("outside 0 to 1"));
  EXPECT_THAT(refusal([] { traced("nan", "0,0\n0.002,nan\n0.003,0\n"); }), HasSubstr("nan.csv:2"));
  EXPECT_THAT(refusal([] { traced("closed", "0,0\n0.002,0\n"); }), HasSubstr("never opens"));
  std::string sampled;
  for (int n = 0; n < 60; ++n)
    if (n < 20 || n > 45) sampled += std::to_string(n * 1e-3) + ",0.5\n";
  EXPECT_THAT(refusal([&] { traced("gap", sampled); }), HasSubstr("gap from 19 ms to 46 ms"));
}

TEST(Valve, RefusesAValveThatNeverBlows) {
  ValveSpec spec = pulse(ValveShape::linear);
  spec.duration = 0.0;
  EXPECT_THAT(refusal([&] { Valve{spec}; }), testing::HasSubstr("never opens"));
  spec = pulse(ValveShape::linear);
  spec.supply_pressure = 90e3;
  EXPECT_THAT(refusal([&] { Valve(spec).require_jet(101325.0); }), testing::HasSubstr("there is no jet"));
}

}  // namespace
}  // namespace ejecta
