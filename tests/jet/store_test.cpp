#include "jet/store.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <fstream>
#include <thread>

#include "app/small_jet.hpp"
#include "case/load.hpp"
#include "scratch_directory.hpp"

namespace ejecta {
namespace {

TEST(JetStore, RunsThatStartTogetherComputeOneJet) {
  const ScratchDirectory scratch;
  setenv("EJECTA_CACHE", scratch.path().c_str(), 1);
  std::ofstream(scratch / "jet.toml") << test::small_jet();
  const Case c = load_case((scratch / "jet.toml").string());
  std::atomic<int> computed = 0;
  std::array<double, 6> thrust{};
  std::vector<std::thread> runs;
  for (double& t : thrust)
    runs.emplace_back([&] {
      t = stored_or_computed_jet(c, 10e-3, [&](const std::string& line) {
            computed += line.starts_with("computing");
          }).momentum(0.1e-3, 1.2);
    });
  for (std::thread& r : runs) r.join();
  EXPECT_EQ(computed, 1);
  EXPECT_GT(thrust[0], 0.0);
  for (const double t : thrust) EXPECT_EQ(t, thrust[0]);
  unsetenv("EJECTA_CACHE");
}

}  // namespace
}  // namespace ejecta
