#include "output/history.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.hpp"
#include "scratch_directory.hpp"

using namespace ejecta;
using namespace ejecta::output;
using testing::HasSubstr;

namespace {
const std::vector<Column> kColumns{{"force_x", "N"}, {"speed", "m/s"}};
const std::vector<std::string> kProvenance{"ejecta test", "case x.toml"};
}  // namespace

TEST(History, HeaderHasProvenanceAndUnits) {
  const ScratchDirectory dir;
  HistoryFile file(dir / "h.csv", kProvenance, kColumns);
  file.add(0.5, std::vector{1.0, -2.5});
  EXPECT_EQ(read_file(dir / "h.csv"),
            "# ejecta test\n# case x.toml\ntime [s],force_x [N],speed [m/s]\n0.5,1,-2.5\n");
}

TEST(History, NumbersComeBackToTheSameBits) {
  const ScratchDirectory dir;
  const std::vector<double> values{1.0 / 3.0, std::nextafter(1e-300, 1.0)};
  HistoryFile file(dir / "h.csv", {}, kColumns);
  file.add(0.1, values);
  const HistoryTable table = read_history(dir / "h.csv");
  EXPECT_EQ(table.values[0][0], 0.1);
  EXPECT_EQ(table.values[1][0], values[0]);
  EXPECT_EQ(table.values[2][0], values[1]);
  EXPECT_EQ(table.columns[2].name, "speed");
  EXPECT_EQ(table.columns[2].unit, "m/s");
}

TEST(History, NanIsRefusedByName) {
  const ScratchDirectory dir;
  HistoryFile file(dir / "h.csv", {}, kColumns);
  try {
    file.add(0.25, std::vector{0.0, std::nan("")});
    FAIL() << "NaN went into a history";
  } catch (const DivergedError& e) {
    EXPECT_THAT(e.what(), HasSubstr("speed"));
    EXPECT_THAT(e.what(), HasSubstr("0.25"));
  }
  EXPECT_TRUE(read_history(dir / "h.csv").values[0].empty());
}

TEST(History, ResumedFileEqualsTheUninterruptedOne) {
  const ScratchDirectory dir;
  const auto row = [](int n) { return std::vector{0.1 * n, std::sqrt(n)}; };
  HistoryFile whole(dir / "whole.csv", kProvenance, kColumns);
  for (int n = 0; n < 10; ++n) whole.add(0.1 * n, row(n));
  {
    HistoryFile killed(dir / "killed.csv", kProvenance, kColumns);
    for (int n = 0; n < 7; ++n) killed.add(0.1 * n, row(n));
  }
  LineFile(dir / "killed.csv", read_file(dir / "killed.csv").size()).append("0.7,0.69");  // torn
  HistoryFile resumed(dir / "killed.csv", kColumns, 0.1 * 4);
  for (int n = 5; n < 10; ++n) resumed.add(0.1 * n, row(n));
  EXPECT_EQ(read_file(dir / "killed.csv"), read_file(dir / "whole.csv"));
}

TEST(History, OtherColumnsCannotBeContinued) {
  const ScratchDirectory dir;
  { HistoryFile(dir / "h.csv", {}, kColumns).add(0.0, std::vector{1.0, 2.0}); }
  EXPECT_THROW(HistoryFile(dir / "h.csv", {{"force_x", "N"}}, 1.0), Error);
}

TEST(History, TornLastLineIsIgnoredByTheReader) {
  const ScratchDirectory dir;
  { HistoryFile(dir / "h.csv", {}, kColumns).add(0.0, std::vector{1.0, 2.0}); }
  LineFile(dir / "h.csv", read_file(dir / "h.csv").size()).append("0.1,3.");
  EXPECT_EQ(read_history(dir / "h.csv").values[0].size(), 1u);
}
