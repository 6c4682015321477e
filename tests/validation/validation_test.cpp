#include "validation/validation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <optional>

#include "base/error.hpp"
#include "case/load.hpp"
#include "scratch_directory.hpp"

using namespace ejecta;
using testing::HasSubstr;
namespace fs = std::filesystem;

namespace {

const nlohmann::json result = nlohmann::json::parse(
    R"({"outcome": "ejected", "bodies": [{"drag_coefficient": 1.10}], "ledger": {"mass": null}})");

ExpectSpec expect(const std::string& quantity) {
  ExpectSpec e;
  e.quantity = quantity;
  return e;
}

ExpectSpec about(double reference, double relative) {
  ExpectSpec e = expect("/bodies/0/drag_coefficient");
  e.reference = reference;
  e.relative_tolerance = relative;
  return e;
}

ExpectSpec says(const std::string& quantity, const std::string& text) {
  ExpectSpec e = expect(quantity);
  e.text = text;
  return e;
}

ExpectSpec at_most(const std::string& quantity, double limit) {
  ExpectSpec e = expect(quantity);
  e.at_most = limit;
  return e;
}

TEST(Compare, NumbersWithinTheirTolerancePass) {
  EXPECT_TRUE(compare(about(1.087, 0.03), result).pass);
  EXPECT_FALSE(compare(about(1.087, 0.01), result).pass);
  EXPECT_EQ(compare(about(1.0, 0.2), result).error, "+10.00 %");
}

TEST(Compare, EveryCriterionMustHold) {
  ExpectSpec e = about(1.087, 0.03);
  e.at_most = 1.05;
  EXPECT_FALSE(compare(e, result).pass);
  e.at_most = 1.2;
  e.at_least = 1.0;
  EXPECT_TRUE(compare(e, result).pass);
}

TEST(Compare, TextsAreEqualOrNot) {
  EXPECT_TRUE(compare(says("/outcome", "ejected"), result).pass);
  EXPECT_FALSE(compare(says("/outcome", "not ejected"), result).pass);
}

TEST(Compare, WhatIsMissingNullOrNanNeverPasses) {
  EXPECT_EQ(compare(at_most("/bodies/3/x", 1.0), result).computed, "missing");
  EXPECT_FALSE(compare(at_most("/bodies/3/x", 1.0), result).pass);
  EXPECT_FALSE(compare(at_most("/ledger/mass", 1.0), result).pass);
  EXPECT_FALSE(compare(at_most("/a", 1.0), {{"a", std::nan("")}}).pass);
}

TEST(Compare, ASeriesShowsEveryGridAndMustShrinkItsChangesIfAsked) {
  const auto grids = [](std::vector<double> values) {
    std::vector<nlohmann::json> list;
    for (double v : values) list.push_back({{"drag", v}});
    return list;
  };
  ExpectSpec e = at_most("/drag", 2.0);
  e.converging = true;
  EXPECT_TRUE(compare_series(e, grids({1.4, 1.2, 1.1})).pass);
  EXPECT_EQ(compare_series(e, grids({1.4, 1.2, 1.1})).series, "1.4 -> 1.2 -> 1.1");
  EXPECT_FALSE(compare_series(e, grids({1.4, 1.3, 1.1})).pass);
  EXPECT_FALSE(compare_series(e, grids({2.4, 2.2, 2.1})).pass) << "the limit still holds";
}

TEST(Refined, CellsTimesTheFactorAndTheStepDividedByIt) {
  Case c;
  c.grid.axis[0] = {{0, 1, 2}, {10, 20}, {}};
  c.grid.axis[1] = {{0, 1}, {1}, {}};
  c.grid.axis[2] = {{0, 1}, {8}, {}};
  c.run.time_step = 0.1;
  const Case fine = refined(c, 2.0);
  EXPECT_EQ(fine.grid.axis[0].cells, (std::vector{20, 40}));
  EXPECT_EQ(fine.grid.axis[1].cells, std::vector{1}) << "a direction that is not there stays so";
  EXPECT_EQ(fine.run.time_step, 0.05);
}

TEST(Orders, FromTheErrorsOfSuccessiveGrids) {
  std::vector<nlohmann::json> levels;
  for (double e : {0.16, 0.04, 0.01}) levels.push_back({{"errors", {{"velocity_l2", e}}}});
  const nlohmann::json combined = with_orders(levels, {1, 2, 4});
  EXPECT_DOUBLE_EQ(combined["observed_orders"]["velocity_l2"][0].get<double>(), 2.0);
  EXPECT_DOUBLE_EQ(combined["observed_order"]["velocity_l2"].get<double>(), 2.0);
  EXPECT_EQ(combined["levels"].size(), 3u);
}

class ValidateCase : public testing::Test {
 protected:
  ScratchDirectory scratch;
  fs::path folder = scratch.path();
  fs::path file = folder / "bounce.toml";
  void SetUp() override {
    std::ofstream(file)
        << "[run]\nend_time = \"1 s\"\n[flow]\nsolver = \"none\"\n[[body]]\ndiameter = \"1 mm\"\n"
           "[[expect]]\nquantity = \"/height\"\nreference = 2\ntolerance = 0.5\nsource = \"by hand\"\n";
  }

  static Runner runner(const std::function<nlohmann::ordered_json()>& result) {
    return {.load = [](const std::string& path) { return load_case(path); },
            .run = [=](const Case&, const fs::path& out) -> std::optional<nlohmann::ordered_json> {
              const nlohmann::ordered_json json = result();
              if (json.empty()) return std::nullopt;
              fs::create_directories(out);
              std::ofstream(out / "result.json") << json;
              return json;
            }};
  }
  Validation with_height(double height) {
    return validate_case(file.string(), "bounce", folder / "runs", runner([=] {
                           return nlohmann::ordered_json{{"height", height}};
                         }));
  }
};

TEST_F(ValidateCase, PassesAndFails) {
  EXPECT_TRUE(with_height(2.1).pass());
  EXPECT_FALSE(with_height(3.0).pass());
  EXPECT_THAT(validation_table({with_height(2.1), with_height(3.0)}), HasSubstr("1 of 2 cases pass"));
}

TEST_F(ValidateCase, AFailedRunIsAFailedCase) {
  const Validation v =
      validate_case(file.string(), "bounce", folder,
                    runner([]() -> nlohmann::ordered_json { throw DivergedError("at t = 1 s"); }));
  EXPECT_FALSE(v.pass());
  EXPECT_EQ(v.failure, "diverged");
  EXPECT_THAT(validation_table({v}), HasSubstr("at t = 1 s"));
}

TEST_F(ValidateCase, AStoppedRunIsNoPass) {
  const Validation v =
      validate_case(file.string(), "bounce", folder, runner([] { return nlohmann::ordered_json(); }));
  EXPECT_FALSE(v.pass());
  EXPECT_EQ(v.failure, "stopped");
}

TEST(NamesOfCases, TellFilesOfEqualNamesApart) {
  EXPECT_EQ(names_of({"a/settling.toml", "b/settling.toml", "b/cavity.toml"}),
            (std::vector<std::string>{"a-settling", "b-settling", "cavity"}));
  EXPECT_EQ(names_of({"x/a/s.toml", "y/a/s.toml"}), (std::vector<std::string>{"x-a-s", "y-a-s"}));
}

TEST_F(ValidateCase, FoundByFileFolderOrPartOfAName) {
  fs::create_directories(folder / "verification" / "dem");
  fs::copy(file, folder / "verification" / "dem" / "bounce.toml");
  EXPECT_EQ(validation_cases({}, folder).size(), 1u);
  EXPECT_EQ(validation_cases({"dem/boun"}, folder).size(), 1u);
  EXPECT_EQ(validation_cases({file.string()}, folder).front(), file);
  EXPECT_EQ(validation_cases({(folder / "verification").string()}, folder).size(), 1u);
  EXPECT_THROW(validation_cases({"nothing-like-it"}, folder), InputError);
}

}  // namespace
