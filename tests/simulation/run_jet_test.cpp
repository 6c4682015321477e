#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

#include "app/small_jet.hpp"
#include "case/load.hpp"
#include "jet/settled.hpp"
#include "scratch_directory.hpp"
#include "simulation/run.hpp"

/// A jet is a run like any other: watched, stopped, resumed.
namespace ejecta {
namespace {

class RunJet : public testing::TestWithParam<bool> {
 protected:
  void SetUp() override { setenv("EJECTA_CACHE", (scratch.path() / "cache").c_str(), 1); }
  void TearDown() override { unsetenv("EJECTA_CACHE"); }
  static Case jet() {
    const Case c =
        parse_case(test::small_jet("[[probe]]\nname = \"near\"\nposition = [\"0 mm\", \"0 mm\", \"5 mm\"]\n"
                                   "[output]\nreport = false\nhistory_interval = \"10 us\"\n"),
                   "small jet");
    return GetParam() ? incompressible_jet(c) : c;
  }
  static std::string text_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  static nlohmann::ordered_json figures_of(Result r) {
    for (const char* key : {"wall_time_s", "cell_steps_per_s", "threads", "operators"})
      r.quantities.erase(key);
    return r.quantities;
  }
  RunFiles files(const std::string& name, bool resume = false) const {
    return {.directory = scratch.path() / name, .resume = resume, .command = "typed"};
  }
  /// The rows without the lines of provenance.
  std::string history(const std::string& run, const std::string& name) const {
    const std::string text = text_of(scratch.path() / run / "history" / (name + ".csv"));
    return text.substr(text.find("\ntime"));
  }
  ScratchDirectory scratch;
};

TEST_P(RunJet, StoppedAndResumedIsTheUndisturbedOne) {
  const Case c = jet();
  const Result whole = run_jet(c, 10e-3, {.files = files("whole")});
  const std::string profile = text_of(whole.quantities["stored_profile"].get<std::string>());
  ASSERT_FALSE(profile.empty());
  // In the rise of the valve, and after the jet was looked at when it blew its strongest.
  for (const double share : {0.1, 0.8}) {
    const std::string name = share < 0.5 ? "early" : "late";
    double time = 0.0;
    const Result stopped = run_jet(c, 10e-3,
                                   {.files = files(name),
                                    .observe = [&](const Moment& m) { time = m.time; },
                                    .stop = [&] { return time >= share * c.run.end_time; }});
    EXPECT_EQ(stopped.end, RunEnd::stopped);
    EXPECT_LT(stopped.steps, whole.steps);
    const Result resumed = run_jet(c, 10e-3, {.files = files(name, true)});
    EXPECT_EQ(figures_of(resumed), figures_of(whole)) << share;
    EXPECT_EQ(text_of(resumed.quantities["stored_profile"].get<std::string>()), profile) << share;
    for (const char* file : {"orifice", "probe-near", "line-centreline"})
      EXPECT_EQ(history(name, file), history("whole", file)) << share << ' ' << file;
  }
}

INSTANTIATE_TEST_SUITE_P(Air, RunJet, testing::Bool(),
                         [](const auto& info) { return info.param ? "Incompressible" : "Compressible"; });

}  // namespace
}  // namespace ejecta
