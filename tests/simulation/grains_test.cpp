#include <gtest/gtest.h>

#include <iterator>

#include "base/parallel.hpp"
#include "case/load.hpp"
#include "case/words.hpp"
#include "coupling/unresolved/grain_drag.hpp"
#include "scratch_directory.hpp"
#include "simulation/run.hpp"

/// Runs with grains: any number of threads and stops give the same bits; lumps and grains share one flow.
namespace ejecta {
namespace {

/// A stream full of fines.
constexpr const char* kDusty = R"(
[run]
end_time = "3 ms"
[flow]
solver = "SOLVER"
turbulence = "laminar"
[grid.x]
points = ["0 mm", "48 mm"]
cells = [24]
[grid.y]
points = ["0 mm", "32 mm"]
cells = [16]
[grid.z]
points = ["0 mm", "32 mm"]
cells = [16]
[boundary.x_min]
type = "velocity"
velocity = ["5 m/s", "0 m/s", "0 m/s"]
[boundary.x_max]
type = "pressure-outlet"
[[initial]]
velocity = ["5 m/s", "0 m/s", "0 m/s"]
[[grains]]
name = "fines"
sizes = "uniform"
size = "0.1 mm"
size_to = "0.3 mm"
count = 1500
region = [["2 mm", "2 mm", "2 mm"], ["46 mm", "30 mm", "30 mm"]]
[output]
report = false
)";
constexpr const char* kBall = R"(
[[body]]
name = "ball"
diameter = "12 mm"
position = ["24 mm", "16 mm", "16 mm"]
)";

struct Dusty {
  std::string solver;
  bool ball;               ///< in the stream
  bool turbulent = false;  ///< and fines spread by eddies
  Case parsed() const {
    std::string text = kDusty;
    const auto replace = [&](const std::string& what, const std::string& by) {
      text.replace(text.find(what), what.size(), by);
    };
    replace("SOLVER", solver);
    if (turbulent) {
      replace("laminar", "k-epsilon");
      replace("[[grains]]",
              "k = \"1 m2/s2\"\nepsilon = \"50 m2/s3\"\n[coupling]\ndispersion = true\n[[grains]]");
    }
    return parse_case(text + (ball ? kBall : ""), "dusty");
  }
  std::string name() const {
    return solver + (ball ? " with a ball" : "") + (turbulent ? " and eddies" : "");
  }
};
const std::vector<Dusty> kAll{{"incompressible", false},
                              {"incompressible", true},
                              {"compressible-piso", false},
                              {"compressible-piso", true},
                              {"incompressible", false, true}};

nlohmann::ordered_json grain_run_figures(Result r) {
  for (const char* key : {"wall_time_s", "cell_steps_per_s", "threads", "operators"}) r.quantities.erase(key);
  return r.quantities;
}

/// The table of laws stands in the order of the words.
TEST(DragLaws, HaveTheirWords) {
  ASSERT_EQ(std::size(drag::kLaws), words(GrainDragLaw{}).size());
  EXPECT_EQ(drag::kLaws[static_cast<std::size_t>(GrainDragLaw::stokes)].beta, drag::stokes);
  EXPECT_EQ(drag::kLaws[static_cast<std::size_t>(GrainDragLaw::di_felice)].beta, drag::di_felice);
  EXPECT_EQ(drag::kLaws[static_cast<std::size_t>(GrainDragLaw::gidaspow)].beta, drag::gidaspow);
}

TEST(RunWithGrains, AnyNumberOfThreadsGivesTheSameBits) {
  const int before = thread_count();
  for (const Dusty& stream : kAll) {
    const Case c = stream.parsed();
    set_thread_count(1);
    const auto one = grain_run_figures(run(c, {}));
    set_thread_count(3);
    EXPECT_EQ(one, grain_run_figures(run(c, {}))) << stream.name();
  }
  set_thread_count(before);
}

TEST(RunWithGrains, StoppedAndResumedIsTheUndisturbedOne) {
  ScratchDirectory scratch;
  for (const Dusty& stream : kAll) {
    const Case c = stream.parsed();
    const auto files = [&](const std::string& name, bool resume) {
      return RunFiles{
          .directory = scratch.path() / (name + stream.name()), .resume = resume, .command = "typed"};
    };
    const auto whole = grain_run_figures(run(c, {.files = files("whole", false)}));
    double time = 0.0;
    run(c, {.files = files("stopped", false),
            .observe = [&](const Moment& m) { time = m.time; },
            .stop = [&] { return time >= 1.5e-3; }});
    EXPECT_EQ(whole, grain_run_figures(run(c, {.files = files("stopped", true)}))) << stream.name();
  }
}

/// Gas, grains and ball lose nothing to each other.
TEST(RunWithGrains, MomentumClosesWithALumpAmongThem) {
  for (const Dusty& stream : kAll) {
    const auto r = grain_run_figures(run(stream.parsed(), {}));
    EXPECT_LT(r["ledger"]["momentum_relative_residual"].get<double>(), 1e-5) << stream.name();
    EXPECT_GT(r["grains"]["drag_N"][0].get<double>(), 0.0);
    EXPECT_GT(r["grains"]["groups"][0]["mean_velocity_m_s"][0].get<double>(), 0.0);
  }
}

/// What grains gained of momentum along the stream is what the flow says that they took.
TEST(RunWithGrains, GrainsGainWhatTheFluidLost) {
  const auto r = grain_run_figures(run(kAll[0].parsed(), {}));
  const double gained = r["grains"]["momentum_N_s"][0].get<double>(),
               lost = r["ledger"]["impulse_on_solids_N_s"][0].get<double>();
  EXPECT_NEAR(gained / lost, 1.0, 1e-4);
}

}  // namespace
}  // namespace ejecta
