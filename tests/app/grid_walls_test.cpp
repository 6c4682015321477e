#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/clock.hpp"
#include "base/error.hpp"
#include "case/load.hpp"
#include "simulation/coupled_model.hpp"

/// Bodies and the walls of the grid.
namespace ejecta {
namespace {

/// A ball of glass 1 mm above the floor of a box of water.
std::string water(const std::string& floor, const std::string& more = "", double z_mm = 6.0) {
  return fmt::format(R"(
[run]
end_time = "0.2 s"
[fluid]
ideal_gas = false
density = "1000 kg/m3"
viscosity = "1e-3 Pa s"
[grid.x]
points = ["-20 mm", "20 mm"]
cells = [20]
[grid.y]
points = ["-20 mm", "20 mm"]
cells = [20]
[grid.z]
points = ["0 mm", "40 mm"]
cells = [20]
[boundary.z_min]
{}
[boundary.z_max]
type = "free-stream"
[[material]]
name = "glass"
density = "2500 kg/m3"
[[material]]
name = "rubber"
[[body]]
name = "ball"
material = "glass"
diameter = "10 mm"
position = ["0 mm", "0 mm", "{} mm"]
{}
)",
                     floor, z_mm, more);
}

double height_after(const Case& c) {
  CoupledModel model(c);
  Clock clock;
  clock.add_event(c.run.end_time);
  while (clock.time() < c.run.end_time) {
    const Step step = clock.next(model.stable_dt(clock.time()));
    model.advance(step);
    clock.tick(step);
  }
  return model.particles().bodies()[0].position.z();
}

std::size_t walls_of(const std::string& text) {
  return CoupledModel(parse_case(text, "water")).particles().walls().size();
}

TEST(GridWalls, ABallInWaterSettlesOnTheFloor) {
  const double z = height_after(parse_case(water("type = \"wall\""), "water"));
  EXPECT_GT(z, 0.0049);
  EXPECT_LT(z, 0.005);
}

TEST(GridWalls, OnlyFacesToWhichFluidSticksHoldBodies) {
  EXPECT_EQ(walls_of(water("type = \"wall\"")), 5u);
  EXPECT_EQ(walls_of(water("type = \"slip\"")), 4u);
  EXPECT_EQ(walls_of(water("type = \"pressure-outlet\"")), 4u);
  const CoupledModel dragged(
      parse_case(water("type = \"moving-wall\"\nvelocity = [\"1 m/s\", \"0 m/s\", \"0 m/s\"]"), "water"));
  EXPECT_EQ(dragged.particles().walls()[4].velocity, Vec3(1, 0, 0));
}

/// Two walls in one place would push twice.
TEST(GridWalls, AWallOfTheCaseInTheFaceStandsForIt) {
  for (const char* wall : {"kind = \"plane\"", "kind = \"plate\"\nsize = [\"30 mm\", \"30 mm\", \"2 mm\"]"}) {
    const std::string own =
        fmt::format("[[wall]]\nname = \"mat\"\nmaterial = \"rubber\"\nnormal = [0, 0, 1]\n{}\n", wall);
    const CoupledModel model(parse_case(water("type = \"wall\"", own), "water"));
    ASSERT_EQ(model.particles().walls().size(), 5u) << wall;
    EXPECT_EQ(model.particles().walls()[0].material, 1);
  }
}

/// What is held is built into the wall, or moved by something else.
TEST(GridWalls, HeldBodiesMayReachIntoAFace) {
  for (const char* motion : {"motion = \"fixed\"", "motion = \"prescribed\""})
    EXPECT_NO_THROW(CoupledModel(parse_case(water("type = \"wall\"", motion, 4.0), "water"))) << motion;
}

TEST(GridWalls, ABodyThatRestsOnAFaceMayDentIt) {
  EXPECT_NO_THROW(CoupledModel(parse_case(water("type = \"wall\"", "", 4.998), "water")));
}

TEST(GridWalls, ABodyThatSticksInAFaceIsRefused) {
  const Case c = parse_case(water("type = \"wall\"", "", 4.0), "water");
  try {
    CoupledModel model(c);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("boundary.z_min"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace ejecta
