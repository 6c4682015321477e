#include "output/progress.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "output/output_file.hpp"
#include "scratch_directory.hpp"

using namespace ejecta::output;
using testing::HasSubstr;
using testing::Not;

namespace {

/// A progress driven through 100 steps of 0.1 s of wall time each.
struct Driven {
  double wall = 0.0;
  std::ostringstream out;
  ProgressOptions options;
  Driven() {
    options.wall_clock = [this] { return wall; };
  }
  void run() {
    Progress progress(out, options);
    for (int n = 0; n <= 100; ++n) {
      progress.update({1e-3 * n, 0.1, n, 1e-3, 0.9, 1000000});
      wall = (n + 1) / 10.0;
    }
    progress.finish({0.1, 0.1, 100, 1e-3, 0.9, 1000000}, "done");
  }
};

}  // namespace

TEST(Progress, LinesEveryFewSecondsInALog) {
  Driven d;
  d.run();
  const std::string text = d.out.str();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3);  // 5 and 10 s, and the end
  EXPECT_THAT(text, HasSubstr("t 50.000/100.000 ms  step 50  Co 0.90  10.0 Mcell/s  5.0 s left"));
  EXPECT_THAT(text, Not(HasSubstr("\x1b")));
}

TEST(Progress, BarOnATerminalWithinItsWidth) {
  Driven d;
  d.options.terminal = true;
  d.options.width = 80;
  d.run();
  EXPECT_THAT(d.out.str(), HasSubstr("\r\x1b[K"));
  EXPECT_THAT(d.out.str(), Not(HasSubstr("\x1b[36m")));  // colour was not asked for
  EXPECT_THAT(d.out.str(), HasSubstr("done at t = 100.000 ms"));
}

TEST(Progress, VerboseIsALineEveryStepEvenOnATerminal) {
  Driven d;
  d.options.verbosity = Verbosity::verbose;
  d.options.terminal = true;
  d.run();
  const std::string text = d.out.str();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 102);  // 101 steps and the end
  EXPECT_THAT(text, Not(HasSubstr("\r")));
}

TEST(Progress, QuietSaysNothingButStillWritesTheFile) {
  const ScratchDirectory dir;
  Driven d;
  d.options.verbosity = Verbosity::quiet;
  d.options.file = dir / "progress.json";
  d.run();
  EXPECT_EQ(d.out.str(), "");
  const auto json = nlohmann::json::parse(read_file(dir / "progress.json"));
  EXPECT_EQ(json["state"], "done");
  EXPECT_EQ(json["step"], 100);
  EXPECT_EQ(json["time_s"], 0.1);
  EXPECT_EQ(json["fraction"], 1.0);
}

TEST(Progress, ResumedRunCountsItsOwnSteps) {
  double wall = 0.0;
  std::ostringstream out;
  ProgressOptions options;
  options.wall_clock = [&] { return wall; };
  Progress progress(out, options);
  progress.update({0.5, 1.0, 500, 1e-3, 1.0, 1000000});
  wall = 10.0;
  progress.update({0.6, 1.0, 600, 1e-3, 1.0, 1000000});
  EXPECT_THAT(out.str(), HasSubstr("10.0 Mcell/s  40.0 s left"));
}

TEST(Progress, TheTimeLeftFollowsTheSpeedOfLate) {
  double wall = 0.0;
  std::ostringstream out;
  ProgressOptions options;
  options.wall_clock = [&] { return wall; };
  Progress progress(out, options);
  for (; wall < 50.0; wall += 1.0) progress.update({1e-3 * wall, 1.0, 0, 1e-3, 1.0, 0});  // 1 ms a second
  for (; wall <= 90.0; wall += 1.0) progress.update({0.05 + 1e-2 * (wall - 50.0), 1.0, 0, 1e-3, 1.0, 0});
  EXPECT_THAT(out.str(), HasSubstr("55.0 s left"));  // of 0.55 s left at 10 ms a second
}

TEST(OperatorTable, AccountsForAllTheTime) {
  const std::vector<ejecta::OperatorTime> operators{{"flow.predict", "", 3.0, 10},
                                                    {"flow.project", "", 5.0, 20}};
  const std::string table = operator_table(operators, 10.0);
  EXPECT_THAT(table, HasSubstr("flow.project      5.000    50.0        20"));
  EXPECT_THAT(table, HasSubstr("the rest          2.000    20.0"));
}

TEST(Duration, ReadsAsPeopleSayIt) {
  EXPECT_EQ(duration_text(3.21), "3.2 s");
  EXPECT_EQ(duration_text(250), "4 min 10 s");
  EXPECT_EQ(duration_text(7500), "2 h 05 min");
}
