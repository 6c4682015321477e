#include "simulation/forecast.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "case/load.hpp"
#include "case/template.hpp"
#include "case/write.hpp"
#include "ejection.hpp"
#include "simulation/assumptions.hpp"
#include "simulation/scene.hpp"

using namespace ejecta;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

namespace {

TEST(Forecast, CountsCells) {
  const Forecast f = forecast(ejection());
  EXPECT_EQ(f.cells, 60 * 60 * 80);
  EXPECT_NEAR(f.smallest_cell, 1e-3, 1e-12);
}

/// 700 kPa gauge is 879 m/s at the nozzle; B d / z at 40 mm makes 5.929 * 1.8 / 40 of it.
TEST(Forecast, TheJetLimitsTheStep) {
  const Forecast f = forecast(ejection());
  EXPECT_NEAR(f.fastest, 879.0 * 5.929 * 1.8 / 40.0, 1.0);
  EXPECT_NEAR(f.time_step, 1e-3 / f.fastest, 1e-9);
}

TEST(Forecast, TheAirEndsWhenTheBodyHasLeftTheBoxOrWhenItHasDied) {
  const double corner = std::sqrt(3.0) * 5e-3;
  EXPECT_NEAR(forecast(ejection()).air_until, 4e-3 + (40e-3 + corner) / 3.0, 1e-4);
  // A slow body sees the air die: u = z / 2t, a thousandth of the energy of u = K / z from 40 to 120 mm.
  const double k = 879.0 * 5.929 * 1.8e-3, moment = (std::pow(0.12, 5) - std::pow(0.04, 5)) / 5.0;
  EXPECT_NEAR(forecast(ejection({"launch.belt_speed=0.5 m/s"})).air_until,
              9e-3 + std::sqrt(moment / (4e-3 * k * k * 0.08)), 1e-4);
}

/// Runs of shipped cases: steps with air and when it ended.
TEST(Forecast, IsWhatRunsTurnedOutToBe) {
  const auto shipped = [](const char* name) {
    return forecast(load_case(std::string(EJECTA_SOURCE_DIR) + "/cases/" + name));
  };
  const Forecast tutorial = shipped("tutorial.toml"), paper = shipped("paper/10mm-cubic.toml"),
                 large = shipped("paper/20mm-cubic.toml");
  EXPECT_NEAR(tutorial.air_until, 23.0e-3, 1e-3);
  EXPECT_NEAR(paper.air_until, 22.2e-3, 1e-3);
  EXPECT_NEAR(large.air_until, 24.4e-3, 2e-3);
  EXPECT_NEAR(static_cast<double>(tutorial.steps), 1250, 0.35 * 1250);
  EXPECT_NEAR(static_cast<double>(paper.steps), 2451, 0.35 * 2451);
}

TEST(Forecast, AJetThatIsComputedFirstIsNotComputedForTheForecast) {
  const Forecast f = forecast(ejection({"jet.kind=computed", "jet.source_case=nowhere.toml"}));
  EXPECT_EQ(f.fastest, forecast(ejection()).fastest);
}

/// Sod: sound of the left state, sqrt(1.4).
TEST(Forecast, SoundLimitsTheStepOfAShockTube) {
  const Forecast f = forecast(parse_case(case_template("shock-tube"), "sod"));
  EXPECT_NEAR(f.fastest, std::sqrt(1.4), 1e-9);
  EXPECT_NEAR(f.time_step, 0.5 * 0.005 / std::sqrt(1.4), 1e-9);
}

TEST(Forecast, NoSpeedGivenNoStepsForetold) {
  EXPECT_EQ(forecast(parse_case(case_template("settling"), "settling")).fastest, 0.0);
}

TEST(Forecast, MemoryAndTimeGrowWithTheCells) {
  const Case coarse = ejection(), fine = ejection({"grid.z.cells=[160]"});
  EXPECT_GT(forecast(fine).memory, 1.5 * forecast(coarse).memory);
  EXPECT_GT(expected_seconds(fine, forecast(fine), 1e10, {}),
            2.0 * expected_seconds(coarse, forecast(coarse), 1e10, {}));
}

TEST(Forecast, FieldOutputNeedsDisk) {
  EXPECT_GT(forecast(ejection({"output.fields_interval=1 ms"})).disk,
            forecast(ejection()).disk + 15 * 288000 * 4.0);
}

std::vector<std::string> assumed(const Case& c) {
  std::vector<std::string> list;
  for (const output::Assumption& a : assumptions(c)) list.push_back(a.key + " = " + a.value);
  return list;
}

/// An assumption is a default that nobody touched, not what the user gave.
TEST(Assumptions, AreDefaultsThatDecideAndThatTheUserHasNotSet) {
  EXPECT_THAT(assumed(ejection()), Contains("valve.rise_time = 6 ms"));
  EXPECT_THAT(assumed(ejection()), Contains("launch.drop_distance = 0.1 m"));
  EXPECT_THAT(assumed(ejection()), Not(Contains(HasSubstr("splitter"))));
  EXPECT_THAT(assumed(ejection({"valve.rise_time=6 ms"})), Not(Contains(HasSubstr("rise_time"))));
  EXPECT_THAT(assumed(parse_case(case_template("cavity"), "cavity")), IsEmpty());
  EXPECT_EQ(assumed(parse_case(write_case(ejection()), "resolved.toml")), assumed(ejection()))
      << "a run of the resolved case assumes the same";
}

TEST(CheckReport, SaysWhatTheRunWillBe) {
  const std::string text = check_report(ejection(), scene_of(ejection()), {}, 1e10);
  EXPECT_THAT(text, HasSubstr("288000"));
  EXPECT_THAT(text, HasSubstr("10.0 cells across"));
  EXPECT_THAT(text, HasSubstr("assumptions, since the case does not say"));
}

TEST(Bandwidth, IsThatOfAComputer) {
  EXPECT_GT(measured_bandwidth(), 1e8);
  EXPECT_LT(measured_bandwidth(), 1e13);
}

}  // namespace
