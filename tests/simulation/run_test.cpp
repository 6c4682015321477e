#include "simulation/run.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <thread>

#include "app/ejection.hpp"
#include "base/error.hpp"
#include "base/file_lock.hpp"
#include "case/load.hpp"
#include "case/sense.hpp"
#include "output/output_file.hpp"
#include "scratch_directory.hpp"
#include "simulation/forecast.hpp"

/// run(case) -> result, as studies, sorters and scripts call it.
namespace ejecta {
namespace {

/// A coarse ejection whose air is computed for a millisecond.
Case short_ejection(double pressure_kPa = 700) {
  return ejection({"run.until=time", "run.end_time=1 ms", "grid.x.cells=[8, 16, 8]",
                   "grid.y.cells=[8, 16, 8]", "grid.z.cells=[40]", "jet.kind=self-similar",
                   "valve.opens_at=0 ms", fmt::format("valve.supply_pressure={} kPa gauge", pressure_kPa),
                   "output.report=false"});
}

/// All that does not depend on when and where it ran.
nlohmann::ordered_json figures_of(Result r) {
  for (const char* key : {"wall_time_s", "cell_steps_per_s", "threads", "operators"}) r.quantities.erase(key);
  return r.quantities;
}

/// How a run ends that is stopped after four steps.
RunEnd end_of_four_steps(const Case& c, const RunFiles& files) {
  std::int64_t step = 0;
  return run(c, {.files = files,
                 .observe = [&](const Moment& m) { step = m.step; },
                 .stop = [&] { return step == 4; }})
      .end;
}

TEST(Run, SideBySideGivesTheBitsOfEachAlone) {
  const std::vector<double> pressures{500, 600, 700};
  std::vector<nlohmann::ordered_json> alone, together(pressures.size());
  for (const double p : pressures) alone.push_back(figures_of(run(short_ejection(p))));
  EXPECT_NE(alone[0], alone[1]);
  std::vector<std::thread> threads;
  for (std::size_t n = 0; n < pressures.size(); ++n)
    threads.emplace_back(
        [&, n] { together[n] = figures_of(run(short_ejection(pressures[n]), {.threads = int(n) + 1})); });
  for (std::thread& t : threads) t.join();
  for (std::size_t n = 0; n < pressures.size(); ++n) EXPECT_EQ(alone[n], together[n]) << pressures[n];
}

/// At once, more than there are cores. EJECTA_SIDE_BY_SIDE: how many.
TEST(Run, SideBySideInOneProcessByTheDozen) {
  const char* const wanted = std::getenv("EJECTA_SIDE_BY_SIDE");
  const std::size_t count = wanted ? std::strtoul(wanted, nullptr, 10) : 12;
  constexpr std::size_t kKinds = 4;
  const auto pressure = [](std::size_t n) { return 500.0 + 50.0 * static_cast<double>(n % kKinds); };
  std::vector<nlohmann::ordered_json> alone, together(count);
  for (std::size_t n = 0; n < kKinds; ++n) alone.push_back(figures_of(run(short_ejection(pressure(n)))));
  std::vector<std::thread> threads;
  for (std::size_t n = 0; n < count; ++n)
    threads.emplace_back(
        [&, n] { together[n] = figures_of(run(short_ejection(pressure(n)), {.threads = 1})); });
  for (std::thread& t : threads) t.join();
  for (std::size_t n = 0; n < count; ++n) EXPECT_EQ(alone[n % kKinds], together[n]) << n;
}

TEST(Run, IsWatchedAndStopped) {
  std::int64_t seen = -1;
  double last = -1.0;
  const Result r = run(short_ejection(), {.observe =
                                              [&](const Moment& m) {
                                                EXPECT_EQ(m.step, seen + 1);
                                                EXPECT_GT(m.time, last);
                                                seen = m.step;
                                                last = m.time;
                                              },
                                          .stop = [&] { return seen == 3; }});
  EXPECT_EQ(r.end, RunEnd::stopped);
  EXPECT_EQ(r.steps, 3);
  EXPECT_EQ(r.time, last);
  EXPECT_TRUE(r.quantities.empty());
}

TEST(Run, StoppedAndResumedIsTheUndisturbedOne) {
  const ScratchDirectory scratch;
  const std::filesystem::path place = scratch.path() / "stopped";
  const Case c = short_ejection();
  std::int64_t step = 0;
  const auto count = [&](const Moment& m) { step = m.step; };
  EXPECT_EQ(run(c, {.files = RunFiles{.directory = place, .command = "typed"},
                    .observe = count,
                    .stop = [&] { return step == 4; }})
                .end,
            RunEnd::stopped);
  EXPECT_FALSE(finished_run(c, place));
  const Result r = run(c, {.files = RunFiles{.directory = place, .resume = true, .command = "typed"}});
  EXPECT_EQ(figures_of(r)["bodies"], figures_of(run(c))["bodies"]);
  ASSERT_TRUE(finished_run(c, place));
  EXPECT_EQ(finished_run(c, place)->quantities["bodies"], r.quantities["bodies"]);
  EXPECT_FALSE(finished_run(short_ejection(600), place)) << "of another case";
}

/// What an [[expect]] may name is what a run says, and nothing else.
TEST(Run, WhatItSaysOfABodyCanBeExpected) {
  Case c = short_ejection();
  const Result r = run(c, {});
  const auto is_refused = [&](const std::string& quantity) {
    c.expects = {{.quantity = quantity, .tolerance = 1.0, .text = "", .source = ""}};
    const std::vector<Problem> problems = check_sense(c);
    return std::any_of(problems.begin(), problems.end(),
                       [](const Problem& p) { return p.key == "expect.0.quantity"; });
  };
  for (const auto& [key, value] : r.quantities["bodies"][0].items())
    EXPECT_FALSE(is_refused("/bodies/0/" + key + (value.is_array() ? "/2" : ""))) << key;
  EXPECT_TRUE(is_refused("/bodies/0/finale_position_m/2"));
}

TEST(Run, ACaseThatCannotStartLeavesTheEarlierRunAsItWas) {
  const ScratchDirectory scratch;
  const std::filesystem::path place = scratch.path() / "run";
  const Case c = short_ejection();
  run(c, {.files = RunFiles{.directory = place, .command = "typed"}});
  Case bad = c;
  bad.valve.shape = ValveShape::trace;
  bad.valve.trace = "no-such-trace.csv";
  EXPECT_THROW(run(bad, {.files = RunFiles{.directory = place, .overwrite = true, .command = "typed"}}),
               Error);
  EXPECT_TRUE(finished_run(c, place));
  EXPECT_THROW(run(c, {.files = RunFiles{.directory = place, .command = "typed"}}), InputError)
      << "not asked for";
  EXPECT_TRUE(finished_run(c, place));
}

TEST(Run, IsNotResumedWithAMeshThatHasChanged) {
  const ScratchDirectory scratch;
  const auto mesh = [&](double height) {
    std::ofstream(scratch / "roof.stl") << fmt::format(
        "solid roof\nfacet normal 0 0 1\nouter loop\nvertex -1 -1 {0}\nvertex 1 -1 {0}\nvertex 0 1 {0}\n"
        "endloop\nendfacet\nendsolid roof\n",
        height);
  };
  mesh(-0.5);
  const std::string text = R"(
[run]
end_time = "5 ms"
[flow]
solver = "none"
[[material]]
name = "ore"
density = "2700 kg/m3"
[[body]]
name = "ball"
shape = "sphere"
diameter = "10 mm"
material = "ore"
[[wall]]
name = "floor"
kind = "mesh"
file = "roof.stl"
material = "ore"
[output]
report = false
)";
  const Case c = parse_case(text, (scratch / "ball.toml").string());
  const std::filesystem::path place = scratch / "run";
  const auto files = [&](bool resume) {
    return RunFiles{.directory = place, .resume = resume, .here = "again"};
  };
  ASSERT_EQ(end_of_four_steps(c, files(false)), RunEnd::stopped);
  mesh(-0.4);
  try {
    run(c, {.files = files(true)});
    FAIL() << "went on with another mesh";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("roof.stl has changed"), std::string::npos) << e.what();
  }
  mesh(-0.5);
  EXPECT_NE(run(c, {.files = files(true)}).end, RunEnd::stopped);
}

/// Neither with another opening curve of the valve nor with another case of the jet.
TEST(Run, IsNotResumedWithATraceOrJetThatHasChanged) {
  const ScratchDirectory scratch;
  const auto write = [&](const char* name, const std::string& text) {
    std::ofstream(scratch / name) << text;
  };
  const std::string opening = "time [ms], opening\n0, 0\n0.2, 1\n8, 1\n",
                    later = "time [ms], opening\n0, 0\n0.3, 1\n8, 1\n";
  const std::string jet = "[run]\nend_time = \"1 ms\"\n";
  Case c = short_ejection();
  c.valve.shape = ValveShape::trace;
  c.valve.trace = (scratch / "opening.csv").string();
  c.jet.source_case =
      (scratch / "jet.toml").string();  // this jet is not computed from it; a file all the same
  const auto files = [&](bool resume) {
    return RunFiles{.directory = scratch.path() / "run", .resume = resume, .here = "again"};
  };
  write("opening.csv", opening);
  write("jet.toml", jet);
  ASSERT_EQ(end_of_four_steps(c, files(false)), RunEnd::stopped);
  const auto refusal = [&] {
    try {
      run(c, {.files = files(true)});
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string("none");
  };
  write("opening.csv", later);
  EXPECT_NE(refusal().find("opening.csv has changed"), std::string::npos) << refusal();
  write("opening.csv", opening);
  write("jet.toml", jet + "title = \"another\"\n");
  EXPECT_NE(refusal().find("jet.toml has changed"), std::string::npos) << refusal();
  write("jet.toml", jet);
  EXPECT_EQ(refusal(), "none");
}

/// What was finished is lost only to what is finished.
TEST(Run, ThatDivergesKeepsTheFinishedOneThatStoodThere) {
  const ScratchDirectory scratch;
  const std::filesystem::path place = scratch.path() / "run";
  const RunFiles anew{.directory = place, .overwrite = true, .command = "typed"};
  const Case c = short_ejection();
  run(c, {.files = RunFiles{.directory = place, .command = "typed"}});
  const std::string before = output::read_file(place / "result.json");
  std::string told;
  std::int64_t step = 0;
  const auto fails_at = [&](std::int64_t n) {
    return Context{.files = anew,
                   .observe =
                       [&, n](const Moment& m) {
                         step = m.step;
                         if (step >= n) throw DivergedError("by the test");
                       },
                   .note = [&](const std::string& sentence) { told = sentence; }};
  };
  for (const std::int64_t n : {0, 3}) {  // the second finds a run without a result, and one put aside
    EXPECT_THROW(run(c, fails_at(n)), DivergedError);
    EXPECT_EQ(output::read_file(place / "earlier" / "result.json"), before);
    EXPECT_FALSE(std::filesystem::exists(place / "result.json"));
    EXPECT_NE(told.find((place / "earlier").string()), std::string::npos) << told;
  }
  run(c, {.files = anew});
  EXPECT_FALSE(std::filesystem::exists(place / "earlier"));
  EXPECT_TRUE(finished_run(c, place));
}

TEST(Run, WithoutFilesItHasTheHistoriesInTheResult) {
  const ScratchDirectory scratch;
  Case c = short_ejection();
  c.output.history_interval = 0.0;
  c.output.slices_interval = 0.1e-3;  // the clock lands on the times of slices whoever looks
  const std::filesystem::path place = scratch.path() / "run";
  const Result with = run(c, {.files = RunFiles{.directory = place, .command = "typed"}});
  const Result without = run(c);
  EXPECT_TRUE(with.histories.empty()) << "they are in the files";
  EXPECT_EQ(figures_of(without), figures_of(with));
  ASSERT_FALSE(without.histories.empty());
  for (const auto& [name, table] : without.histories) {
    const auto file = output::read_history(place / "history" / (name + ".csv"));
    EXPECT_EQ(table.values, file.values) << name;
    ASSERT_EQ(table.columns.size(), file.columns.size());
    for (std::size_t n = 0; n < table.columns.size(); ++n) {
      EXPECT_EQ(table.columns[n].name, file.columns[n].name);
      EXPECT_EQ(table.columns[n].unit, file.columns[n].unit);
    }
  }
  EXPECT_TRUE(run(c, {.keep_histories = false}).histories.empty());
}

TEST(Run, KeepsTheFieldsOfItsLastMomentWhereTheyAreWanted) {
  const Case c = short_ejection();
  EXPECT_FALSE(run(c).fields);
  const Result r = run(c, {.keep_fields = true});
  ASSERT_TRUE(r.fields);
  const std::size_t cells =
      (r.fields->faces[0].size() - 1) * (r.fields->faces[1].size() - 1) * (r.fields->faces[2].size() - 1);
  EXPECT_EQ(cells, std::size_t(r.quantities["cells"]));
  for (const ResultField& f : r.fields->fields) EXPECT_EQ(f.values.size(), cells * std::size_t(f.components));
}

/// A sphere held in a stream of water that rises, slowly enough for its buoyancy to be as large as its drag.
Case sphere_in_water(double gravity) {
  return parse_case(fmt::format(R"([run]
end_time = "60 ms"
[flow]
solver = "incompressible"
[fluid]
ideal_gas = false
density = "1000 kg/m3"
viscosity = "0.1 Pa s"
[environment]
gravity = ["0 m/s2", "0 m/s2", "{} m/s2"]
[grid]
x = {{ points = ["-40 mm", "40 mm"], cells = [16] }}
y = {{ points = ["-40 mm", "40 mm"], cells = [16] }}
z = {{ points = ["-40 mm", "40 mm"], cells = [16] }}
[boundary]
z_min = {{ type = "velocity", velocity = ["0 m/s", "0 m/s", "1 m/s"] }}
z_max = {{ type = "free-stream" }}
[stream]
velocity = ["0 m/s", "0 m/s", "1 m/s"]
[[body]]
shape = "sphere"
diameter = "24 mm"
motion = "fixed"
)",
                                gravity),
                    "water.toml");
}

/// Unlike the force, which a balance would show.
/// A tenth of the density of the water around it, and three times as wide as thick: what it accelerates of
/// the water is more than ten times its own mass.
TEST(Run, AFlatBodyRisesInWater) {
  const Case c = parse_case(R"(
[run]
end_time = "60 ms"
courant = 0.5
[fluid]
ideal_gas = false
density = "1000 kg/m3"
viscosity = "0.001 Pa s"
[grid.x]
points = ["-40 mm", "40 mm"]
cells = [20]
[grid.y]
points = ["-40 mm", "40 mm"]
cells = [20]
[grid.z]
points = ["0 mm", "60 mm"]
cells = [30]
[[material]]
name = "foam"
density = "100 kg/m3"
[[body]]
name = "plate"
shape = "box"
size = ["24 mm", "24 mm", "8 mm"]
material = "foam"
position = ["0.2 mm", "0.3 mm", "20 mm"]
[output]
report = false
)",
                            "plate");
  const Result r = run(c);
  const double rise = r.quantities["bodies"][0]["final_position_m"][2].get<double>() - 0.020;
  // In ideal fluid, with the added mass of a square of that width, 0.4 rho w^3 (drag makes it less).
  const double ideal = 0.5 * 9.81 * 900.0 / (100.0 + 0.4 * 24.0 / 8.0 * 1000.0) * 0.06 * 0.06;
  EXPECT_GT(rise, 0.4 * ideal);
  EXPECT_LT(rise, ideal);
}

/// What flows at this speed (m/s) through a channel between walls 2 m apart, of 20 cells, as [fluid] and
/// [flow] say.
Case channel(const std::string& fluid_and_flow, double seconds, double speed) {
  return parse_case(fmt::format(R"(
[run]
end_time = "{} s"
[environment]
gravity = ["0 m/s2", "0 m/s2", "0 m/s2"]
{}
[grid.x]
points = ["0 m", "0.4 m"]
cells = [4]
[grid.y]
points = ["-1 m", "1 m"]
cells = [20]
[grid.z]
points = ["0 m", "0.4 m"]
cells = [4]
[boundary.x_min]
type = "periodic"
[boundary.x_max]
type = "periodic"
[boundary.z_min]
type = "periodic"
[boundary.z_max]
type = "periodic"
[[initial]]
velocity = ["{} m/s", "0 m/s", "0 m/s"]
k = "3 m2/s2"
epsilon = "5 m2/s3"
[[probe]]
name = "centre"
position = ["0.2 m", "0 m", "0.2 m"]
[output]
report = false
)",
                                seconds, fluid_and_flow, speed),
                    "channel");
}

/// The centre of a channel at Re_tau 2000 (Hoyas & Jimenez 2006: 24.1 to 24.4 times the friction velocity,
/// which the driving force says), by 20 cells, the first in the logarithmic layer.
TEST(Run, AChannelHasTheFrictionOfItsWalls) {
  for (const char* model : {"k-epsilon", "k-omega-sst"}) {
    const Case c = channel(fmt::format(R"(
[fluid]
ideal_gas = false
density = "1 kg/m3"
viscosity = "0.0005 Pa s"
[flow]
turbulence = "{}"
body_force = ["1 m/s2", "0 m/s2", "0 m/s2"]
)",
                                       model),
                           40, 20);
    const double centre = run(c).quantities["probes"]["centre"]["velocity_x"].get<double>();
    EXPECT_NEAR(centre, 24.25, 0.06 * 24.25) << model;
  }
}

/// A cube in a turbulent stream, 10 cells across. The same cube cut out of a body-fitted grid, with wall
/// functions: C_D 1.550 with 10 cells across, 1.522 with 20, mean from 0.35 to 0.5 ms (pimpleFoam, standard
/// k-epsilon).
TEST(Run, ACubeHasItsDragWhereverItLiesInTheGrid) {
  for (const double place : {0.0, 0.25, 0.5}) {  // mm, of cells of 1 mm
    const Case c = parse_case(fmt::format(R"(
[run]
end_time = "0.5 ms"
courant = 0.9
[environment]
gravity = ["0 m/s2", "0 m/s2", "0 m/s2"]
[fluid]
ideal_gas = false
density = "1.1839 kg/m3"
viscosity = "1.85e-5 Pa s"
[flow]
turbulence = "k-epsilon"
[grid.x]
points = ["-15 mm", "30 mm"]
cells = [45]
[grid.y]
points = ["-15 mm", "15 mm"]
cells = [30]
[grid.z]
points = ["-15 mm", "15 mm"]
cells = [30]
[boundary.x_min]
type = "velocity"
velocity = ["100 m/s", "0 m/s", "0 m/s"]
k = "150 m2/s2"
epsilon = "5e5 m2/s3"
[boundary.x_max]
type = "pressure-outlet"
[boundary.y_min]
type = "slip"
[boundary.y_max]
type = "slip"
[boundary.z_min]
type = "slip"
[boundary.z_max]
type = "slip"
[[initial]]
velocity = ["100 m/s", "0 m/s", "0 m/s"]
k = "150 m2/s2"
epsilon = "5e5 m2/s3"
[[material]]
name = "solid"
density = "1000 kg/m3"
[[body]]
name = "cube"
shape = "box"
size = ["10 mm", "10 mm", "10 mm"]
motion = "fixed"
position = ["{0} mm", "{0} mm", "{0} mm"]
[stream]
velocity = ["100 m/s", "0 m/s", "0 m/s"]
average_from = "0.35 ms"
[output]
report = false
)",
                                          place),
                              "cube");
    EXPECT_NEAR(run(c).quantities["bodies"][0]["drag_coefficient"].get<double>(), 1.536, 0.12 * 1.536)
        << place;
  }
}

/// Gas that slows down in a channel does so as liquid does, by either method: where k was produced by
/// differences across the walls they stopped it within seconds.
TEST(Run, GasInAChannelHasTheFrictionOfItsWalls) {
  const auto momentum_left = [](const char* model, const char* solver, double seconds) {
    const Case c = channel(fmt::format(R"(
[fluid]
viscosity = "0.0006 Pa s"
[flow]
solver = "{}"
turbulence = "{}"
)",
                                       solver, model),
                           seconds, 22);
    return run(c).quantities["air_momentum_N_s"][0].get<double>() / (1.1839 * 0.32 * 22.0);
  };
  for (const char* model : {"k-epsilon", "k-omega-sst"}) {
    const double liquid = momentum_left(model, "incompressible", 4),
                 gas = momentum_left(model, "compressible-piso", 4);
    EXPECT_LT(liquid, 0.9) << model;
    EXPECT_NEAR(1.0 - gas, 1.0 - liquid, 0.03 * (1.0 - liquid)) << model;
  }
  const double liquid = momentum_left("k-epsilon", "incompressible", 0.5),
               gas = momentum_left("k-epsilon", "compressible", 0.5);
  EXPECT_NEAR(1.0 - gas, 1.0 - liquid, 0.06 * (1.0 - liquid));
}

/// In steps of a hundred crossings of a cell by sound nothing grows out of what the pressure equation leaves.
TEST(Run, SlowGasStaysSlow) {
  const Case c = parse_case(R"toml(
[run]
end_time = "10 ms"
time_step_max = "0.1 ms"
[environment]
gravity = ["0 m/s2", "0 m/s2", "0 m/s2"]
[flow]
solver = "compressible-piso"
[grid.x]
points = ["-15 mm", "15 mm"]
cells = [24]
[grid.y]
points = ["-15 mm", "15 mm"]
cells = [24]
[grid.z]
points = ["-15 mm", "15 mm"]
cells = [24]
[boundary.x_min]
type = "pressure-outlet"
[boundary.x_max]
type = "pressure-outlet"
[boundary.y_min]
type = "pressure-outlet"
[boundary.y_max]
type = "pressure-outlet"
[boundary.z_min]
type = "pressure-outlet"
[boundary.z_max]
type = "pressure-outlet"
[[initial]]
velocity = ["= 1e-3*sin(400*y)", "0 m/s", "0 m/s"]
[[probe]]
name = "inside"
position = ["7 mm", "3 mm", "4 mm"]
[output]
report = false
)toml",
                            "slow gas");
  const auto probe = run(c).quantities["probes"]["inside"];
  for (const char* d : {"x", "y", "z"})
    EXPECT_LT(std::abs(probe[std::string("peak_velocity_") + d].get<double>()), 1.5e-3) << d;
}

TEST(Run, DragIsWithoutBuoyancy) {
  const auto body = [](double gravity) { return run(sphere_in_water(gravity)).quantities["bodies"][0]; };
  const auto still = body(0.0), heavy = body(-9.81);
  const double drag = still["drag_coefficient"];
  EXPECT_GT(drag, 0.0);
  EXPECT_NEAR(heavy["drag_coefficient"], drag, 1e-6 * drag);
  EXPECT_NEAR(heavy["mean_force_N"][2].get<double>() - still["mean_force_N"][2].get<double>(),
              1000.0 * 9.81 * std::numbers::pi / 6.0 * std::pow(24e-3, 3), 1e-6);
}

/// check tells the steps that viscosity asks for.
TEST(Run, StepsOfAViscousFlowAreForetold) {
  Case c = sphere_in_water(0.0);
  c.fluid.viscosity = 50.0;
  const double steps = run(c).quantities["steps"];
  EXPECT_NEAR(double(forecast(c).steps), steps, 0.1 * steps);
}

TEST(Run, LeavesARunInPeaceThatGoesOnElsewhere) {
  const ScratchDirectory scratch;
  const std::filesystem::path place = scratch.path() / "run";
  const Case c = short_ejection();
  run(c, {.files = RunFiles{.directory = place, .command = "typed"}});
  {
    const DirectoryClaim somebody(place);
    EXPECT_THROW(run(c, {.files = RunFiles{.directory = place, .overwrite = true, .command = "typed"}}),
                 InputError);
  }
  EXPECT_TRUE(finished_run(c, place)) << "as it was";
  run(c, {.files = RunFiles{.directory = place, .overwrite = true, .command = "typed"}});
}

}  // namespace
}  // namespace ejecta
