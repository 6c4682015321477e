#include "simulation/body_checks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "case/load.hpp"
#include "case/template.hpp"
#include "flow/model/flow_model.hpp"
#include "refused_cases.hpp"

using namespace ejecta;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

namespace {

/// Every file of tests/bad_bodies is refused by what `check` and `run` read cases with.
class BadBody : public testing::TestWithParam<std::string> {};

TEST_P(BadBody, IsRefusedWithItsMessage) {
  refused::expect_refusal(GetParam(), [](const std::string& path) { load_checked(path); });
}

INSTANTIATE_TEST_SUITE_P(AllFiles, BadBody, testing::ValuesIn(refused::files("bad_bodies")),
                         refused::name_of);

std::vector<std::string> words_of(const std::vector<Problem>& problems) {
  std::vector<std::string> list;
  for (const Problem& p : problems)
    list.push_back((p.severity == Severity::error ? "error: " : "warning: ") + p.key + ": " + p.what);
  return list;
}

std::vector<std::string> found(const std::vector<std::string>& overrides,
                               const std::string& kind = "ejection") {
  return words_of(check_bodies(parse_case(case_template(kind), kind, overrides)));
}

TEST(BodyChecks, AGoodCaseHasNothingWrong) {
  for (const Word& kind : template_kinds()) EXPECT_THAT(found({}, kind.name), IsEmpty()) << kind.name;
}

TEST(BodyChecks, FewCellsAcrossABody) {
  EXPECT_THAT(found({"body.0.size=[\"10 mm\", \"10 mm\", \"6 mm\"]"}),
              Contains(HasSubstr("warning: body.0: 6.0 cells across the smallest feature (6 mm)")));
}

/// Of a case that has one already, too.
TEST(BodyChecks, TheRefinementThatIsAdvisedIsEnough) {
  const auto checked = [](const std::string& refinement) {
    return check_bodies(parse_case(case_template("ejection"), "ejection", {"grid.refinement=" + refinement}));
  };
  const std::vector<Problem> coarse = checked("0.5");
  ASSERT_EQ(coarse.size(), 1u);
  const std::string advised = coarse[0].example.substr(coarse[0].example.find("= ") + 2);
  EXPECT_LT(std::stod(advised), 1.0);
  EXPECT_THAT(words_of(checked(advised)), IsEmpty());
}

/// A box 60 mm wide with cells of the given widths.
Case box(int nx, int nz, const std::string& body, const std::string& x_max = "wall") {
  return parse_case("[run]\nend_time = \"1 ms\"\n[grid.x]\npoints = [\"-30 mm\", \"30 mm\"]\ncells = " +
                        std::to_string(nx) +
                        "\n[grid.y]\npoints = [\"-30 mm\", \"30 mm\"]\ncells = 60\n[grid.z]\npoints = "
                        "[\"-30 mm\", \"30 mm\"]\ncells = " +
                        std::to_string(nz) + "\n[boundary.x_max]\ntype = \"" + x_max + "\"\n[[body]]\n" +
                        body,
                    "box.toml");
}

/// The sphere about a rod 58 mm long is larger than the box, the rod is not; aslant it is.
TEST(BodyChecks, TheTrueExtentMustFitTheBox) {
  const std::string rod = "shape = \"box\"\nsize = [\"58 mm\", \"30 mm\", \"30 mm\"]\nmotion = \"fixed\"\n";
  EXPECT_THAT(words_of(check_bodies(box(60, 60, rod))), IsEmpty());
  EXPECT_THAT(
      words_of(check_bodies(box(60, 60, rod + "rotation_axis = [0, 1, 0]\nrotation_angle = \"40 deg\"\n"))),
      Contains(HasSubstr("larger than the box along x: 63.71 mm in 60 mm")));
}

/// Fine cells are needed where the plate is thin, whichever way it is turned, and nowhere else.
TEST(BodyChecks, APlateIsResolvedInItsThickness) {
  const std::string plate = "shape = \"box\"\nsize = [\"40 mm\", \"40 mm\", \"4 mm\"]\n";
  EXPECT_THAT(words_of(check_bodies(box(15, 120, plate))), IsEmpty()) << "4 mm cells along it, 0.5 mm across";
  const std::string upright = plate + "rotation_axis = [0, 1, 0]\nrotation_angle = \"90 deg\"\n";
  EXPECT_THAT(words_of(check_bodies(box(15, 120, upright))),
              Contains(HasSubstr("error: body.0: 1.0 cells across the smallest feature")));
  EXPECT_THAT(words_of(check_bodies(box(120, 15, upright))), IsEmpty());
}

TEST(BodyChecks, AslantTheCellsCountByTheirShare) {
  const Case c = box(30, 60,
                     "shape = \"box\"\nsize = [\"40 mm\", \"20 mm\", \"8 mm\"]\nrotation_axis = [0, 1, 0]\n"
                     "rotation_angle = \"45 deg\"\n");
  const Body body = make_body(c.bodies[0], Materials(c), "");
  const Resolution r = resolution_of(make_grid(c), body, Vec3(0, 0, 0));
  EXPECT_NEAR(r.cells, 8.0 / std::sqrt(0.5 * 2 * 2 + 0.5 * 1 * 1), 1e-9);
  EXPECT_NEAR(std::abs(r.width.direction.x()), std::sqrt(0.5), 1e-9);
}

/// A polyhedron that is a box is counted as one.
TEST(BodyChecks, AHullOfEightCornersIsABox) {
  const std::string hull =
      "shape = \"polyhedron\"\nvertices = [[\"-20 mm\", \"-20 mm\", \"-2 mm\"], [\"20 mm\", \"-20 "
      "mm\", \"-2 mm\"], [\"-20 mm\", \"20 mm\", \"-2 mm\"], [\"20 mm\", \"20 mm\", \"-2 mm\"], "
      "[\"-20 mm\", \"-20 mm\", \"2 mm\"], [\"20 mm\", \"-20 mm\", \"2 mm\"], [\"-20 mm\", \"20 "
      "mm\", \"2 mm\"], [\"20 mm\", \"20 mm\", \"2 mm\"]]\n";
  EXPECT_THAT(words_of(check_bodies(box(15, 120, hull))), IsEmpty());
  EXPECT_THAT(words_of(check_bodies(box(120, 15, hull))),
              Contains(HasSubstr("1.0 cells across the smallest feature")));
}

TEST(BodyChecks, WhatSticksOut) {
  const std::string
      cube =
          "shape = \"box\"\nsize = [\"10 mm\", \"10 mm\", \"10 mm\"]\nposition = [\"27 mm\", \"0 m\", "
          "\"0 m\"]\n",
      fixed = "motion = \"fixed\"\n";
  EXPECT_THAT(words_of(check_bodies(box(60, 60, cube, "wall"))),
              Contains(HasSubstr("2 mm inside the wall x_max")));
  EXPECT_THAT(words_of(check_bodies(box(60, 60, cube + fixed, "wall"))), IsEmpty()) << "built into the wall";
  EXPECT_THAT(words_of(check_bodies(box(60, 60, cube + fixed, "symmetry"))), IsEmpty()) << "half a body";
  EXPECT_THAT(
      words_of(check_bodies(box(60, 60, cube, "pressure-outlet"))),
      Contains(HasSubstr("warning: body.0.position: the body starts 2 mm outside the box through x_max")));
  EXPECT_THAT(
      words_of(check_bodies(box(60, 60, cube, "total-pressure"))),
      Contains(HasSubstr("error: body.0.position: the body sticks 2 mm out of the box through x_max")));
}

TEST(BodyChecks, ABodyThatStartsOutside) {
  EXPECT_THAT(found({"body.0.on_belt=false", "body.0.position=[\"1 m\", \"0 m\", \"0 m\"]",
                     "body.0.velocity=[\"1 m/s\", \"0 m/s\", \"0 m/s\"]"}),
              Contains(HasSubstr("warning: body.0.position: the body starts outside")));
}

/// Without a flow there is no box to compare with: a body of metres is only unlikely.
TEST(BodyChecks, AMeshOfMetresIsAskedAbout) {
  const std::string file = EJECTA_SOURCE_DIR "/tests/good_cases/tetrahedron.stl";
  const std::string text =
      "[run]\nend_time = \"1 ms\"\n[flow]\nsolver = \"none\"\n[[body]]\nshape = \"mesh\"\nfile = \"" + file +
      "\"\n";
  EXPECT_THAT(words_of(check_bodies(parse_case(text, "mesh.toml"))),
              Contains(HasSubstr("warning: body.0: the body is")));
  EXPECT_THAT(words_of(check_bodies(parse_case(text + "scale = 0.001\n", "mesh.toml"))), IsEmpty());
}

}  // namespace
