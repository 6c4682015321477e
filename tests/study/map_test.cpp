#include "study/map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "base/error.hpp"
#include "case/extent.hpp"
#include "case/node_path.hpp"
#include "case/symmetry.hpp"
#include "output/output_file.hpp"
#include "scratch_directory.hpp"
#include "study/map_case.hpp"
#include "study/perform.hpp"
#include "study/study.hpp"

namespace ejecta {
namespace {

using Json = nlohmann::ordered_json;
using testing::HasSubstr;

constexpr const char* kCase = R"([run]
title = "an egg"
until = "verdict"
end_time = "150 ms"
[flow]
turbulence = "k-epsilon"
[grid.x]
points = ["-40 mm", "40 mm"]
cells = [64]
[grid.y]
points = ["-40 mm", "-12 mm", "12 mm", "40 mm"]
cells = [10, 24, 10]
grading = [0.3, 1, 3.3]
[grid.z]
points = ["40 mm", "120 mm"]
cells = [64]
[boundary.x_min]
type = "free-stream"
[boundary.x_max]
type = "free-stream"
[boundary.y_min]
type = "free-stream"
[boundary.y_max]
type = "free-stream"
[boundary.z_min]
type = "jet"
[boundary.z_max]
type = "free-stream"
[valve]
supply_pressure = "700 kPa gauge"
[[body]]
name = "cube"
shape = "box"
size = ["10 mm", "10 mm", "8 mm"]
on_belt = true
[launch]
belt_speed = "3 m/s"
[splitter]
distance = "250 mm"
height = "18 mm"
[map]
along = ["-30 mm", "24 mm"]
across = ["-18 mm", "18 mm"]
plate_error = ["0 mm", "1 mm"]
coarse_refinement = 1
)";

/// Ejected from an ellipse about x = -3 mm with half axes of 15 and 10 mm; clearance in mm as far out.
constexpr double kHalfX = 15e-3, kHalfY = 10e-3;
double clearance(double x, double y) { return 0.03 * (1.0 - std::hypot((x + 3e-3) / kHalfX, y / kHalfY)); }

/// Stands for a run: it ends behind the plate, on the flight that has the clearance of its place.
RunAnswer flown(const Case& c, const RunRequest&) {
  const BodySpec& b = c.bodies[0];
  const Vec3 g = c.environment.gravity, v(3.0, 0.0, 0.4);
  const double t = 0.004;  // since it passed the edge
  const Vec3 at_edge(0.25, b.across, 0.08 + clearance(b.along, b.across));
  const Vec3 end = at_edge + t * v + 0.5 * t * t * g, velocity = v + t * g;
  Json body{{"name", b.name},
            {"outcome", at_edge.z() > 0.08 ? "ejected" : "not ejected"},
            {"final_position_m", {end.x(), end.y(), end.z()}},
            {"final_velocity_m_s", {velocity.x(), velocity.y(), velocity.z()}}};
  return {.stopped = false,
          .quantities = {{"bodies", {body}}, {"plate", {{"edge_from_nozzle_m", {0.25, 0.08}}}}},
          .wall_time = 1.0};
}

class Maps : public testing::Test {
 protected:
  Case read(std::string text = kCase, const std::vector<std::string>& set = {}) {
    return parse_case(text, "egg.toml", set);
  }
  /// `count` runs, then it is stopped.
  MapEnd map(const Case& base, const std::string& name, int count = 1000, RunFunction run = flown) {
    TaskStore store = TaskStore::create(folder_ / name, study_header("map", base), false);
    MapWorkers workers;
    workers.run = [&](const TaskStore& tasks, std::span<const std::size_t> which) {
      std::vector<std::size_t> order(which.rbegin(), which.rend());  // in any order
      for (const std::size_t task : order) {
        if (tasks.state(task) == TaskState::done) continue;
        if (--count < 0) return false;
        perform_task(tasks, task, 1, run, {});
      }
      return true;
    };
    return make_map(base, store, workers);
  }
  Json result(const std::string& name) {
    return Json::parse(output::read_file(folder_ / name / "result.json"));
  }
  static Json without_times(Json r) {
    for (const char* key : {"wall_time_s", "runs_wall_time_s"}) r.erase(key);
    return r;
  }
  ScratchDirectory folder_;
};

TEST_F(Maps, FindsAnEllipseWithItsErrors) {
  map(read(), "egg");
  const Json r = result("egg");
  const double truth = std::numbers::pi * kHalfX * kHalfY;
  EXPECT_NEAR(r["area_m2"], truth, 0.02 * truth);
  EXPECT_LE(std::abs(r["area_m2"].get<double>() - truth), r["area_error_m2"].get<double>() + 1e-3 * truth);
  EXPECT_NEAR(r["half_width_across_m"], kHalfY, 0.4e-3);
  EXPECT_NEAR(r["length_before_m"], kHalfX + 3e-3, 0.5e-3);
  EXPECT_NEAR(r["length_behind_m"], kHalfX - 3e-3, 0.5e-3);
  EXPECT_TRUE(r["symmetric"].get<bool>());
  EXPECT_LE(r["runs"].size(), 35u);
  EXPECT_EQ(r["runs_coarse"], 0);
  EXPECT_EQ(r["runs_fine"], r["runs"].size());
  EXPECT_GT(r["outline_m"].size(), 20u);
  EXPECT_TRUE(r["contradictions"].empty());
  for (const Json& run : r["runs"]) EXPECT_NEAR(run["clearance_m"], clearance(run["x_m"], run["y_m"]), 1e-9);
  // A plate 1 mm higher: half axes shorter by 1/30 of themselves.
  ASSERT_EQ(r["plates"].size(), 2u);
  const double higher = r["plates"][1]["area_m2"];
  EXPECT_NEAR(higher, truth * std::pow(29.0 / 30.0, 2), 0.02 * truth);
  // At the paper's resolution: 0.5 mm across.
  for (const Json& row : r["paper_resolution"]) {
    const double x = row["x_m"],
                 half = kHalfY * std::sqrt(std::max(0.0, 1 - std::pow((x + 3e-3) / kHalfX, 2)));
    EXPECT_NEAR(row["y_high_m"], half, 0.9e-3);
  }
}

TEST_F(Maps, OnAGridEveryPlaceOfItIsRun) {
  map(read(kCase, {"map.grid=[\"5 mm\", \"3 mm\"]", "map.max_runs=100", "map.coarse_refinement=0.5"}),
      "grid");
  const Json r = result("grid");
  EXPECT_EQ(r["state"], "finished");
  EXPECT_EQ(r["runs_coarse"], 0);
  for (const Json& run : r["runs"]) {
    EXPECT_NEAR(std::remainder(run["x_m"].get<double>(), 5e-3), 0.0, 1e-12);
    EXPECT_NEAR(std::remainder(run["y_m"].get<double>(), 3e-3), 0.0, 1e-12);
  }
  const double truth = std::numbers::pi * kHalfX * kHalfY;
  EXPECT_NEAR(r["area_of_plate_as_given_m2"], truth, r["area_error_m2"].get<double>());
  EXPECT_LT(r["area_error_m2"], 0.1 * truth);
  EXPECT_EQ(r["plates"].size(), 2u);
}

/// Cubes of 80 to 120 % that lie turned: the larger ones are not thrown as high.
TEST_F(Maps, OfAClassIsAChanceOfEjection) {
  const Case base =
      read(std::string(kCase) +
           "lying = \"turned\"\nsize_factor = [0.8, 1.2]\narrival_error = [\"1 mm\", \"1 mm\"]\n"
           "max_runs = 40\n");
  const auto thrown = [](const Case& c, const RunRequest& request) {
    RunAnswer answer = flown(c, request);
    answer.quantities["bodies"][0]["final_position_m"][2] =
        answer.quantities["bodies"][0]["final_position_m"][2].get<double>() +
        0.05 * (1.0 - c.bodies[0].size.x() / 10e-3);
    return answer;
  };
  map(base, "class", 1000, thrown);
  const Json r = result("class");
  // Clearances are 10 mm more or less at the ends, evenly spread: the mean over the class of the ellipses.
  double truth = 0.0;
  for (int n = 0; n < 1000; ++n) {
    const double grown = 1.0 + (0.01 - 0.02 * (n + 0.5) / 1000) / 0.03;
    truth += std::numbers::pi * kHalfX * kHalfY * grown * grown / 1000;
  }
  EXPECT_NEAR(r["area_m2"], truth, r["area_error_m2"].get<double>());
  EXPECT_LT(r["area_error_m2"], 0.35 * truth);
  EXPECT_TRUE(r["symmetric"].get<bool>());
  double least = 2.0, most = 0.0;
  for (const Json& run : r["runs"]) {
    least = std::min(least, run["size_factor"].get<double>());
    most = std::max(most, run["size_factor"].get<double>());
    EXPECT_NEAR(std::hypot(run["turn_wxyz"][0].get<double>(), run["turn_wxyz"][3].get<double>()), 1.0, 1e-12);
  }
  EXPECT_GE(least, 0.8);
  EXPECT_LT(least, 0.87);
  EXPECT_GT(most, 1.13);
  EXPECT_LE(most, 1.2);
  const Json& chance = r["chance"];
  ASSERT_EQ(chance["chance"].size(), chance["y_m"].size());
  ASSERT_EQ(chance["chance"][0].size(), chance["x_m"].size());
  EXPECT_EQ(chance["contours"].size(), 3u);
  map(base, "again", 1000, thrown);
  EXPECT_EQ(without_times(r), without_times(result("again")));
}

TEST_F(Maps, MembersOfAClassAreTheBodyScaledAndTurned) {
  Case base = read();
  base.map.lying = MapLying::any;
  base.map.size_factor = {2.0, 2.0};
  base.bodies[0].mass = 1e-3;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  constexpr int kPlaces = 400;
  for (int n = 0; n < kPlaces; ++n) {
    const Case c = map_run_case(base, {{1e-4 * n - 0.02, 0.003}, Fidelity::fine});
    EXPECT_NEAR(c.bodies[0].size.x(), 20e-3, 1e-12);
    EXPECT_NEAR(*c.bodies[0].mass, 8e-3, 1e-12);
    mean += Eigen::AngleAxisd(c.bodies[0].rotation_angle, c.bodies[0].rotation_axis) *
            Eigen::Vector3d(1.0, 0.5, 0.2) / kPlaces;
  }
  EXPECT_LT(mean.norm(), 4.0 / std::sqrt(double(kPlaces)));  // no direction is preferred
  const Case coarse = map_run_case(base, {{0.001, 0.003}, Fidelity::coarse}),
             fine = map_run_case(base, {{0.001, 0.003}, Fidelity::fine});
  EXPECT_EQ(coarse.bodies[0].rotation_angle, fine.bodies[0].rotation_angle);
}

TEST_F(Maps, StoppedAndStartedAgainItIsTheSameMap) {
  map(read(), "whole");
  MapEnd end = MapEnd::stopped;
  int calls = 0;
  for (; end == MapEnd::stopped; ++calls) end = map(read(), "parts", 5);
  EXPECT_GT(calls, 2);
  EXPECT_EQ(without_times(result("whole")), without_times(result("parts")));
}

TEST_F(Maps, TwoFidelitiesWorkTogether) {
  const RunFunction two = [](const Case& c, const RunRequest& r) {
    RunAnswer a = flown(c, r);
    // The coarse grid lifts the body 2 mm too high at the plate.
    if (c.grid.axis[0].cells[0] < 64) {
      Json& z = a.quantities["bodies"][0]["final_position_m"][2];
      z = z.get<double>() + 2e-3;
    }
    return a;
  };
  map(read(kCase, {"map.coarse_refinement=0.5", "map.max_runs=60", "map.plate_error=[\"0 mm\", \"0 mm\"]"}),
      "two", 1000, two);
  const Json r = result("two");
  const double truth = std::numbers::pi * kHalfX * kHalfY;
  EXPECT_NEAR(r["area_m2"], truth, 0.025 * truth) << r["history"].dump();
  EXPECT_GE(r["runs_fine"], 5);
  EXPECT_GT(r["runs_coarse"], 10);
  EXPECT_LE(r["runs_fine"], 15);
}

TEST_F(Maps, AClaimedSymmetryIsChecked) {
  const RunFunction aslant = [](const Case& c, const RunRequest& r) {
    RunAnswer a = flown(c, r);
    Json& z = a.quantities["bodies"][0]["final_position_m"][2];
    if (c.bodies[0].across < 0.0) z = z.get<double>() - 0.02;
    return a;
  };
  std::string text = kCase;
  text += "symmetric = true\n[[wall]]\npoint = [\"0 m\", \"0 m\", \"-1 m\"]\n";  // a wall: nobody can be sure
  map(read(text), "claimed", 1000, flown);
  EXPECT_FALSE(result("claimed")["mirror_check"]["contradicts"].get<bool>());
  EXPECT_FALSE(result("claimed")["mirror_check"].empty());
  EXPECT_EQ(map(read(text, {"run.title=\"aslant\""}), "aslant", 1000, aslant), MapEnd::contradicted);
  EXPECT_NEAR(result("aslant")["mirror_check"]["clearance_mirrored_m"],
              result("aslant")["mirror_check"]["clearance_m"].get<double>() - 0.02, 1e-9);
  EXPECT_THAT(result("aslant")["summary"].get<std::string>(), HasSubstr("mirror image"));
}

TEST_F(Maps, ARunThatFailsIsNamedAndTheRestGoesOn) {
  int n = 0;
  const RunFunction failing = [&](const Case& c, const RunRequest& r) {
    if (++n == 7) throw DivergedError("the flow diverged");
    return flown(c, r);
  };
  map(read(), "failing", 1000, failing);
  const Json r = result("failing");
  int failed = 0;
  for (const Json& run : r["runs"])
    if (run["outcome"] == "diverged") {
      ++failed;
      EXPECT_EQ(run["reason"], "the flow diverged");
      EXPECT_TRUE(run["clearance_m"].is_null());
    }
  EXPECT_EQ(failed, 1);
  const double truth = std::numbers::pi * kHalfX * kHalfY;
  EXPECT_NEAR(r["area_m2"], truth, 0.03 * truth);
}

TEST_F(Maps, AskedForTogetherOrAloneNothingDependsOnWhoRuns) {
  // Another order of the runs (as of more cores) gives the same map: map() runs them backwards.
  const Case base = read();
  TaskStore store = TaskStore::create(folder_ / "forwards", study_header("map", base), false);
  MapWorkers workers;
  workers.run = [&](const TaskStore& tasks, std::span<const std::size_t> which) {
    for (const std::size_t task : which) perform_task(tasks, task, 1, flown, {});
    return true;
  };
  make_map(base, store, workers);
  map(base, "backwards");
  EXPECT_EQ(without_times(result("forwards")), without_times(result("backwards")));
}

TEST_F(Maps, WhatCannotRunAtTheRimIsRefusedBeforeTheFirstRun) {
  const Case base = read();
  TaskStore store = TaskStore::create(folder_ / "rim", study_header("map", base), false);
  MapWorkers workers;
  workers.run = [](const TaskStore&, std::span<const std::size_t>) -> bool { throw Error("was run"); };
  workers.further = [](const Case& c) {
    std::vector<Problem> problems;
    if (c.bodies[0].across > 0.0) problems.push_back({.key = "body.0.size", .what = "too coarse out there"});
    return problems;
  };
  try {
    make_map(base, store, workers);
    ADD_FAILURE() << "was accepted";
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("y = 18 mm"));
    EXPECT_THAT(e.what(), HasSubstr("too coarse out there"));
  }

  // With the file at hand: the line of what is at fault.
  std::ofstream(folder_ / "egg.toml") << kCase;
  const Node tree = case_tree(folder_ / "egg.toml");
  workers.place = [&](const std::string& key) { return locate(tree, key); };
  try {
    make_map(base, store, workers);
    ADD_FAILURE() << "was accepted";
  } catch (const CaseError& e) {
    ASSERT_EQ(e.problems.size(), 1u);
    EXPECT_EQ(e.problems[0].key, "map.across");
    EXPECT_THAT(e.what(), HasSubstr("across = [\"-18 mm\", \"18 mm\"]"));
    EXPECT_THAT(e.what(), HasSubstr("^~"));
  }
}

TEST(MapRuns, PlaceTheBodyAndMoveTheFineCellsByWholeCells) {
  const Case base = parse_case(kCase, "egg.toml", {"launch.offset_along=2 mm"});
  const Case c = map_run_case(base, {{-9e-3, 7.3e-3}, Fidelity::fine});
  EXPECT_DOUBLE_EQ(c.bodies[0].along + c.launch.offset_along, -9e-3);
  EXPECT_DOUBLE_EQ(c.bodies[0].across, 7.3e-3);
  EXPECT_FALSE(c.splitter.solid);
  const double moved = c.grid.axis[1].points[1] - base.grid.axis[1].points[1];
  EXPECT_NEAR(moved, 4e-3, 1e-12);  // 3.65 mm, in cells of 1 mm
  EXPECT_EQ(map_run_case(base, {{0, 0}, Fidelity::coarse}).grid.axis[1].cells, base.grid.axis[1].cells);
  const Case finer = parse_case(kCase, "egg.toml", {"map.coarse_refinement=0.5"});
  EXPECT_EQ(map_run_case(finer, {{0, 0}, Fidelity::coarse}).grid.axis[1].cells, (std::vector<int>{5, 12, 5}));
}

TEST(MapRuns, AFlightHasAClearanceForEveryPlate) {
  MapFlight f{.outcome = "ejected",
              .x = 0.26,
              .z = 0.1,
              .velocity_x = 2.0,
              .velocity_z = -0.5,
              .edge_x = 0.25,
              .edge_z = 0.08,
              .gravity_z = -10.0};
  EXPECT_NEAR(f.clearance(), 0.1 + 0.5 * 0.005 - 5.0 * 0.005 * 0.005 - 0.08, 1e-15);
  EXPECT_NEAR(f.clearance({0.0, 0.002}), f.clearance() - 0.002, 1e-15);
  EXPECT_NEAR(f.clearance({0.01, 0.0}), 0.02, 1e-15);
  f.velocity_x = -0.1;
  EXPECT_LT(f.clearance(), -0.2);
}

TEST(MapRuns, FootprintIsTheBoxFromAbove) {
  const Case base = parse_case(kCase, "egg.toml");
  EXPECT_NEAR(signed_area(footprint(base)), 1e-4, 1e-10);
  const Case turned =
      parse_case(kCase, "egg.toml", {"body.0.rotation_axis=[0,0,1]", "body.0.rotation_angle=30 deg"});
  EXPECT_NEAR(signed_area(footprint(turned)), 1e-4, 1e-10);
  EXPECT_FALSE(map_is_symmetric(turned));
}

}  // namespace
}  // namespace ejecta
