#include "case/load.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "base/error.hpp"
#include "case/write.hpp"

using namespace ejecta;
using testing::HasSubstr;

namespace {

const std::string paper = R"toml(
[run]
title = "one ejection"
until = "verdict"
end_time = "120 ms"
courant = 1.2

[environment]
pressure = "101325 Pa absolute"

[flow]
turbulence = "k-epsilon"

[grid.x]
points = ["-60 mm", "-10 mm", "10 mm", "60 mm"]
cells = [40, 40, 40]
grading = [0.25, 1, 4]
[grid.y]
points = ["-40 mm", "40 mm"]
cells = 80
[grid.z]
points = ["40 mm", "120 mm"]
cells = [90]

[boundary.z_min]
type = "jet"
[boundary.z_max]
type = "free-stream"
pressure = "0 Pa gauge"

[[boundary.x_min.patch]]
type = "velocity"
centre = ["-60 mm", "0 mm", "50 mm"]
radius = "2 mm"
velocity = ["= 3 * step(t - 1e-3)", "0 m/s", "1 cm/s"]

[[initial]]
pressure = "101.325 kPa absolute"

[valve]
supply_pressure = "700 kPa gauge"

[[body]]
name = "cube"
shape = "cluster"
size = ["10 mm", "10 mm", "10 mm"]
sphere_diameter = "5 mm"
on_belt = true

[[body]]
shape = "multisphere"
spheres = [["0 mm", "0 mm", "0 mm", "5 mm"], ["4 mm", "0 mm", "0 mm", "3 mm"]]
position = ["8 mm", "0 mm", "100 mm"]
rotation_angle = "90 deg"

[launch]
stand_off = "75 mm"

[splitter]
)toml";

TEST(LoadCase, ReadsQuantitiesIntoSi) {
  const Case c = parse_case(paper, "paper.toml");
  EXPECT_EQ(c.run.until, RunUntil::verdict);
  EXPECT_DOUBLE_EQ(c.run.end_time, 0.12);
  EXPECT_EQ(c.run.courant, 1.2);
  EXPECT_EQ(c.grid.axis[0].points, (std::vector{-0.06, -0.01, 0.01, 0.06}));
  EXPECT_EQ(c.grid.axis[1].cells, std::vector{80});
  EXPECT_EQ(c.valve.supply_pressure, 801325.0);
  EXPECT_EQ(c.boundary[4].type, BoundaryType::jet);
  EXPECT_EQ(c.boundary[0].patches.at(0).state.velocity->at(0), "3 * step(t - 1e-3)");
  EXPECT_EQ(c.boundary[0].patches.at(0).state.velocity->at(2), "0.01");
  EXPECT_EQ(c.initial.at(0).state.pressure, "0") << "incompressible flow holds gauge pressure";
  EXPECT_TRUE(c.launch.enabled);
  EXPECT_TRUE(c.splitter.enabled);
  EXPECT_FALSE(c.stream.enabled);
  EXPECT_EQ(c.bodies.at(1).name, "body-2");
  EXPECT_EQ(c.bodies[1].spheres.at(1)[3], 0.003);
  EXPECT_NEAR(c.fluid.density, 1.1839, 1e-4);
}

TEST(LoadCase, GaugeIsRelativeToTheAmbientPressure) {
  const Case c = parse_case(paper, "paper.toml", {"environment.pressure=90 kPa absolute"});
  EXPECT_EQ(c.valve.supply_pressure, 790000.0);
}

TEST(LoadCase, OverridesReachListElementsByNumberAndName) {
  const Case c = parse_case(
      paper, "paper.toml",
      {"body.1.position=[\"1 mm\", \"2 mm\", \"100 mm\"]", "body.cube.mass=2.7 g", "run.courant=0.8"});
  EXPECT_EQ(c.bodies[1].position, Vec3(0.001, 0.002, 0.1));
  EXPECT_EQ(c.bodies[0].mass, 0.0027);
  EXPECT_EQ(c.run.courant, 0.8);
}

TEST(LoadCase, RefinementMultipliesCellsAndIsWrittenAsTheGridThatIsUsed) {
  const Case fine = parse_case(paper, "paper.toml", {"grid.refinement=2"});
  EXPECT_EQ(fine.grid.axis[0].cells, (std::vector{80, 80, 80}));
  EXPECT_EQ(fine.grid.axis[1].cells, std::vector{160});
  EXPECT_EQ(parse_case(write_case(fine), "written.toml").grid.axis[0].cells, fine.grid.axis[0].cells);
  const Case flat = parse_case(paper, "paper.toml", {"grid.refinement=2", "grid.y.cells=1"});
  EXPECT_EQ(flat.grid.axis[1].cells, std::vector{1}) << "a direction of one cell is not resolved";
}

TEST(LoadCase, WhatIsWrittenIsReadBackToTheSameText) {
  const std::string once = write_case(parse_case(paper, "paper.toml"));
  const std::string twice = write_case(parse_case(once, "resolved.toml"));
  EXPECT_EQ(once, twice);

  Case turned = parse_case(paper, "paper.toml");  // as arithmetic makes them: zeros with a sign
  turned.bodies.at(0).rotation_axis = {-0.0, 0.0, -1.0};
  turned.bodies.at(0).rotation_angle = -0.5;
  const std::string first = write_case(turned);
  EXPECT_EQ(first, write_case(parse_case(first, "resolved.toml")));
}

TEST(LoadCase, EveryNameOfAFileCanBeMadeAbsolute) {
  Case c;
  c.path = "somewhere/case.toml";
  c.valve.trace = "valve.csv";
  c.jet.source_case = "../jet.toml";
  c.bodies.resize(1);
  c.bodies[0].file = "a.stl";
  c.bodies[0].files = {"b.stl", "/c.stl"};
  c.walls.resize(1);
  c.walls[0].file = "chute.stl";
  c.measured.resize(1);
  c.measured[0].file = "pitot.csv";
  const auto here = std::filesystem::current_path();
  const Case moved = with_absolute_files(c);
  EXPECT_EQ(moved.valve.trace, here / "somewhere/valve.csv");
  EXPECT_EQ(moved.jet.source_case, here / "jet.toml");
  EXPECT_EQ(moved.bodies[0].file, here / "somewhere/a.stl");
  EXPECT_EQ(moved.bodies[0].files, (std::vector<std::string>{here / "somewhere/b.stl", "/c.stl"}));
  EXPECT_EQ(moved.walls[0].file, here / "somewhere/chute.stl");
  EXPECT_EQ(moved.measured[0].file, here / "somewhere/pitot.csv");
}

TEST(LoadCase, AllErrorsOfAFileAtOnce) {
  try {
    parse_case("[run]\nend_time = 8\ncouran = 1\n[flow]\nturbulence = \"k-omega\"\n", "x.toml");
    FAIL() << "accepted";
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("x.toml:2"));
    EXPECT_THAT(e.what(), HasSubstr("x.toml:3"));
    EXPECT_THAT(e.what(), HasSubstr("x.toml:5"));
    EXPECT_THAT(e.what(), HasSubstr("grid.x: the flow has no cells")) << "sense as well as reading";
    EXPECT_THAT(e.what(), HasSubstr("6 errors"));
  }
}

}  // namespace
