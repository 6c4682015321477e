#include "simulation/prospect.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "case/copies.hpp"
#include "case/load.hpp"
#include "case/template.hpp"
#include "ejection.hpp"
#include "scratch_directory.hpp"
#include "simulation/body_checks.hpp"
#include "simulation/forecast.hpp"
#include "simulation/scene.hpp"

using namespace ejecta;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// What `check` tells of bodies that no air touches: when they meet the jet and the plate, and what misses.
namespace {

std::vector<std::string> warnings(const std::vector<std::string>& overrides) {
  std::vector<std::string> list;
  for (const Problem& p : check_bodies(ejection(overrides))) {
    EXPECT_EQ(p.severity, Severity::warning) << p.what;
    list.push_back(p.key + ": " + p.what);
  }
  return list;
}

TEST(Prospects, AGoodCaseHasNoWarnings) { EXPECT_THAT(warnings({}), IsEmpty()); }

TEST(Prospects, APulseTooEarlyOrTooLateMisses) {
  EXPECT_THAT(warnings({"launch.arrives_at=60 ms"}),
              Contains(HasSubstr("the pulse misses \"cube\" altogether")));
  EXPECT_THAT(warnings({"valve.opens_at=50 ms"}), Contains(HasSubstr("the jet blows from 50 ms to 59 ms")));
  EXPECT_THAT(warnings({"valve.opens_at=50 ms", "valve.more_pulses=[\"2 ms\"]"}), IsEmpty())
      << "a later pulse hits";
}

/// offset_along moves the path: at 3 m/s, 30 mm are 10 ms.
TEST(Prospects, TheOffsetAlongTheBeltShiftsTheMeeting) {
  EXPECT_THAT(warnings({"launch.arrives_at=50 ms", "launch.offset_along=30 mm", "valve.opens_at=36 ms"}),
              IsEmpty());
  EXPECT_THAT(warnings({"launch.arrives_at=50 ms", "launch.offset_along=-30 mm", "valve.opens_at=36 ms"}),
              Contains(HasSubstr("misses")));
}

TEST(Prospects, AMissInPlaceIsToldLikeOneInTime) {
  EXPECT_THAT(warnings({"launch.offset_across=30 mm"}),
              Contains(HasSubstr("launch.offset_across: the jet misses \"cube\": undisturbed it passes")));
  EXPECT_THAT(warnings({"body.0.across=-30 mm"}),
              Contains(HasSubstr("body.0.on_belt: the jet misses \"cube\"")));
}

TEST(Prospects, AWayOutAgainstTheWindIsTold) {
  EXPECT_THAT(warnings({"boundary.x_max.type=velocity",
                        "boundary.x_max.velocity=[\"-1 m/s\", \"0 m/s\", \"0 m/s\"]"}),
              Contains(HasSubstr("through x_max, where air flows in")));
}

TEST(Prospects, AnEndBeforeThePlateIsTold) {
  EXPECT_THAT(warnings({"run.end_time=30 ms"}),
              Contains(HasSubstr("run.end_time: the run ends at 30 ms, before any body comes to the plate")));
}

TEST(Prospects, AValveThatNeverOpensFullyIsTold) {
  EXPECT_THAT(warnings({"valve.duration=3 ms"}),
              Contains(HasSubstr("the valve never opens fully: it takes 6 ms to open (by default)")));
  EXPECT_NEAR(prospect_of_valve(ejection({"valve.duration=3 ms"})).widest, 0.5, 1e-6);
  EXPECT_THAT(warnings({"valve.duration=3 ms", "valve.rise_time=1 ms"}), IsEmpty());
}

/// A cube of 10 mm at 3 m/s, 75 mm over the nozzle where the jet is 2 x 2 x 0.094 x 75 mm wide.
TEST(Prospects, TimesAreThoseOfTheFreeFlight) {
  const Case c = with_copies(ejection());
  const Company company = company_of(c);
  Scene scene = make_scene(c, nullptr);
  const Prospect p = prospect_of(c, company, 0, &*scene.splitter);
  ASSERT_TRUE(p.over_jet && p.at_plate);
  const double half = (5e-3 + 2 * 0.094 * 75e-3) / 3.0;
  EXPECT_NEAR(p.over_jet->to, 4e-3 + half, 2e-4);
  EXPECT_NEAR(*p.at_plate, 4e-3 + 0.25 / 3.0, 1e-9);
  EXPECT_NEAR(p.above_edge, -45e-3, 1e-9) << "45 mm below the edge, by definition";
}

double edge_z(const std::vector<std::string>& overrides) {
  const Case c = with_copies(ejection(overrides));
  return make_scene(c, nullptr).splitter->edge().z();
}

/// A plate above the path follows it; one that is fixed to the machine does not.
TEST(Plate, OnlyThatOfTheMachineStaysWhereItIs) {
  EXPECT_GT(edge_z({"launch.belt_speed=3.5 m/s"}) - edge_z({"launch.belt_speed=2 m/s"}), 0.09);
  std::string text = case_template("ejection");
  text.replace(text.find("distance = \"250 mm\""), std::string("distance = \"250 mm\"").size(),
               "edge = [\"250 mm\", \"34 mm\"]");
  const auto at = text.find("height = \"45 mm\"");
  text.replace(at, 1, "#");
  for (const char* speed : {"2 m/s", "3.5 m/s"}) {
    const Case c = with_copies(
        parse_case(text, "fixed.toml",
                   {std::string("launch.belt_speed=") + speed, "jet.nozzle=[\"1 mm\", \"0 mm\", \"2 mm\"]"}));
    const Vec3 edge = make_scene(c, nullptr).splitter->edge();
    EXPECT_NEAR(edge.x(), 0.251, 1e-12);
    EXPECT_NEAR(edge.z(), 0.036, 1e-12);
    EXPECT_THAT(check_report(c, scene_of(c), {}, 1e10),
                HasSubstr("edge at x, z = 250, 34 mm from the nozzle, fixed to the machine"));
  }
}

TEST(CheckReport, ShowsBodyValveAndPlate) {
  const std::string text = check_report(ejection(), scene_of(ejection()), {}, 1e10);
  EXPECT_THAT(text, HasSubstr("10 x 10 x 10 mm, 1 cm3, 2.7 g"));
  EXPECT_THAT(text, HasSubstr("past the plate's edge at 87.3 ms, 45 mm below it"));
  EXPECT_THAT(text, HasSubstr("is fully open from 6 ms to 8 ms, shut at 9 ms"));
  EXPECT_THAT(text, HasSubstr("45 mm above the undisturbed path there, with which it moves"));
}

/// A square of 10 units in x and y, scaled to mm, turned upright about y and put 100 mm along x.
TEST(Walls, FromFilesHaveAScaleAndAPlace) {
  const ScratchDirectory scratch;
  std::ofstream(scratch / "sheet.stl")
      << "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 10 0 0\n"
         "vertex 10 10 0\nendloop\nendfacet\nfacet normal 0 0 1\nouter loop\n"
         "vertex 0 0 0\nvertex 10 10 0\nvertex 0 10 0\nendloop\nendfacet\nendsolid s\n";
  const auto refused = [&](const char* position, const char* place) {
    const std::string text =
        std::string(
            "[run]\nend_time = \"1 ms\"\n[flow]\nsolver = \"none\"\n[[body]]\ndiameter = "
            "\"4 mm\"\nposition = ") +
        position + "\n[[wall]]\nname = \"sheet\"\nkind = \"mesh\"\nfile = \"sheet.stl\"\n" + place;
    for (const Problem& p : check_bodies(parse_case(text, (scratch / "case.toml").string())))
      if (p.severity == Severity::error) return p.what;
    return std::string();
  };
  const char* upright =
      "scale = 0.001\npoint = [\"100 mm\", \"0 mm\", \"0 mm\"]\nrotation_axis = [0, 1, 0]\nrotation_angle = "
      "\"90 deg\"\n";
  EXPECT_THAT(refused("[\"100.5 mm\", \"3 mm\", \"-6 mm\"]", upright), HasSubstr("overlaps wall \"sheet\""));
  EXPECT_EQ(refused("[\"106 mm\", \"3 mm\", \"0.5 mm\"]", upright), "");
  EXPECT_THAT(refused("[\"106 mm\", \"3 mm\", \"0.5 mm\"]",
                      "scale = 0.001\npoint = [\"100 mm\", \"0 mm\", \"0 mm\"]\n"),
              HasSubstr("overlaps wall \"sheet\""));
}

/// Two bodies on one belt: the gap is that between their surfaces, whatever their shapes and turns.
TEST(Belt, ABodyBehindAnotherKeepsItsGap) {
  const Case c = with_copies(parse_case(R"([run]
end_time = "1 ms"
[flow]
solver = "none"
[[body]]
name = "rod"
shape = "box"
size = ["20 mm", "4 mm", "4 mm"]
rotation_angle = "30 deg"
on_belt = true
[[body]]
name = "ball"
diameter = "6 mm"
on_belt = true
behind = "rod"
gap = "12 mm"
across = "2 mm"
[[body]]
name = "late"
diameter = "8 mm"
on_belt = true
behind = "ball"
[launch]
)",
                                        "belt.toml"));
  const Scene s = make_scene(c, nullptr);
  const auto end = [&](std::size_t n, int sign) {
    const Reach r = reach_of(s.particles.bodies()[n]);
    return s.particles.bodies()[n].position.x() + (sign > 0 ? r.high.x() : r.low.x());
  };
  EXPECT_NEAR(end(0, -1) - end(1, 1), 12e-3, 1e-12);
  EXPECT_NEAR(end(1, -1) - end(2, 1), 0.0, 1e-12);
  EXPECT_NEAR(s.particles.bodies()[1].position.y(), 2e-3, 1e-15);
  EXPECT_NEAR(s.particles.bodies()[1].velocity.x(), 3.0, 1e-12);
}

}  // namespace
