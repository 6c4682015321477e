#include "case/sense.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "base/error.hpp"
#include "case/extent.hpp"
#include "case/load.hpp"
#include "case/template.hpp"
#include "scratch_directory.hpp"

using namespace ejecta;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

/// What is only unlikely to be meant: warnings. What is refused stands in tests/bad_cases.
namespace {

std::vector<std::string> warnings(const std::vector<std::string>& overrides,
                                  const std::string& kind = "ejection") {
  std::vector<std::string> list;
  for (const Problem& p : check_sense(parse_case(case_template(kind), kind, overrides))) {
    EXPECT_EQ(p.severity, Severity::warning) << p.what;
    list.push_back(p.key + ": " + p.what);
  }
  return list;
}

TEST(Sense, AGoodCaseHasNoWarnings) {
  for (const Word& kind : template_kinds()) EXPECT_THAT(warnings({}, kind.name), IsEmpty()) << kind.name;
}

TEST(Sense, ABodyThatIsNeverReleased) {
  EXPECT_THAT(warnings({"body.0.release_at=2 s"}, "settling"), Contains(HasSubstr("never released")));
}

/// What is wrong in a file of a path is shown there, under the key that names the file.
TEST(Sense, AWrongPathFileIsShownWithItsLine) {
  const ScratchDirectory scratch;
  std::ofstream(scratch / "path.csv") << "t [ms], z [mm]\n0, 0\n5; 1\n";
  try {
    parse_case(
        "[run]\nend_time = \"1 ms\"\n[flow]\nsolver = \"none\"\n[[body]]\ndiameter = \"1 mm\"\n"
        "motion = \"prescribed\"\npath = \"path.csv\"\n",
        (scratch / "case.toml").string());
    FAIL() << "was accepted";
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("path.csv:3: error: body.0.path: 1 values for 2 columns"));
    EXPECT_THAT(e.what(), HasSubstr("    3 | 5; 1\n      | ^~~~"));
  }
}

TEST(Sense, ALaunchWithoutABody) {
  EXPECT_THAT(warnings({"body.0.on_belt=false", "body.0.position=[\"0 mm\", \"0 mm\", \"75 mm\"]"}),
              Contains(HasSubstr("no body comes from the belt")));
}

TEST(Sense, KeysThatTheModelsLeaveAsideAreNamed) {
  EXPECT_THAT(warnings({"flow.solver=none"}, "settling"),
              Contains(AllOf(HasSubstr("`grid.x.cells`"), HasSubstr("nothing with flow.solver \"none\""))));
  EXPECT_THAT(warnings({"boundary.x_max.type=wall", "boundary.x_max.temperature=300 K"}, "settling"),
              Contains(AllOf(HasSubstr("`boundary.x_max.temperature`"), HasSubstr("does nothing"))));
}

TEST(Extent, WidthsOfAGradedBlockAreAGeometricSeries) {
  double sum = 0.0;
  for (int i = 0; i < 10; ++i) sum += cell_width(1.0, 10, 4.0, i);
  EXPECT_NEAR(sum, 1.0, 1e-14);
  EXPECT_NEAR(cell_width(1.0, 10, 4.0, 9) / cell_width(1.0, 10, 4.0, 0), 4.0, 1e-12);
  EXPECT_EQ(cell_width(1.0, 10, 1.0, 3), 0.1);
}

TEST(Extent, WidestCellWhereTheBodyIs) {
  const AxisSpec axis{{0.0, 1.0, 2.0}, {10, 10}, {1.0, 4.0}};
  EXPECT_NEAR(widest_cell(axis, 0.2, 0.4), 0.1, 1e-12);
  EXPECT_NEAR(widest_cell(axis, 5.0, 6.0), cell_width(1.0, 10, 4.0, 9), 1e-12) << "outside: the nearest cell";
  EXPECT_GT(widest_cell(axis, 0.5, 1.5), 0.1);
}

std::string refusal(const std::vector<std::string>& overrides) {
  try {
    parse_case(case_template("ejection"), "ejection", overrides);
  } catch (const InputError& e) {
    return e.what();
  }
  return "accepted";
}

TEST(Overrides, WrongOnesSayWhatIsWrong) {
  EXPECT_THAT(refusal({"run.end_time"}), HasSubstr("no key=value"));
  EXPECT_THAT(refusal({"=1"}), HasSubstr("no key=value"));
  EXPECT_THAT(refusal({"run.title=\"a\nb"}), HasSubstr("not TOML"));
  EXPECT_THAT(refusal({"run.end_time=[1"}), HasSubstr("--set run.end_time=[1: error: run.end_time: "));
  EXPECT_THAT(refusal({"valve.supply_pressure=6 bar"}), HasSubstr("does not say gauge or absolute"));
}

TEST(Overrides, WrongNamesTellTheNearest) {
  const std::pair<const char*, const char*> meant[] = {
      {"run.curant=1", "courant"},
      {"valv.duration=1 ms", "valve.duration"},
      {"valv.duratoin=1 ms", "valve.duration"},
      {"machine.supply_presure=1", "valve.supply_pressure"},
      {"supply_pressure=1", "valve.supply_pressure"},
      {"suply_pressure=1", "valve.supply_pressure"},
      {"boundary.z_mim.type=wall", "z_min.type"},
      {"body.7.mass=1 g", "body.cube.mass"},
      {"body.cubbe.mass=1 g", "body.cube.mass"},
      {"body.cube.mas=1 g", "mass"},
      {"body.mass=1 g", "body.cube.mass"},
      {"run.title.x=1", "run.title"},
  };
  for (const auto& [given, near] : meant)
    EXPECT_THAT(refusal({given}), AllOf(HasSubstr(fmt::format("--set {}: ", given)),
                                        HasSubstr(fmt::format("nearest:  {}\n", near))))
        << given;
}

TEST(Overrides, ASectionMayBeNew) {
  const Case c = parse_case(case_template("ejection"), "ejection",
                            {"checkpoint.every_steps=100", "stream.average_from=1 ms"});
  EXPECT_EQ(c.checkpoint.every_steps, 100);
  EXPECT_TRUE(c.stream.enabled);
}

}  // namespace
