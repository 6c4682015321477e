#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/error.hpp"
#include "case/load.hpp"
#include "scratch_directory.hpp"

namespace ejecta {
namespace {

using testing::HasSubstr;

class Extends : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"floor.stl", "jets/floor.stl", "shared/parts/floor.stl", "own/own.stl"})
      write(name,
            "solid floor\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
            "endfacet\nendsolid floor\n");
  }
  std::string write(const std::string& name, const std::string& text) {
    const std::filesystem::path file = scratch.path() / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text;
    return file.string();
  }
  static std::string error_of(const std::string& file) {
    try {
      load_case(file);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  }
  ScratchDirectory scratch;
  const std::string base = R"([run]
end_time = "1 s"
courant = 0.5
[flow]
solver = "none"
[[material]]
name = "ore"
[[body]]
name = "rock"
diameter = "10 mm"
[[wall]]
name = "floor"
kind = "mesh"
file = "floor.stl"
)";
};

TEST_F(Extends, KeysReplaceThoseOfTheBaseOneByOne) {
  write("base.toml", base);
  const Case c = load_case(write("own.toml", "extends = \"base.toml\"\n[run]\nend_time = \"2 s\"\n"));
  EXPECT_EQ(c.run.end_time, 2.0);
  EXPECT_EQ(c.run.courant, 0.5);
  EXPECT_EQ(c.bodies.size(), 1u);
}

TEST_F(Extends, AnElementChangesTheOneOfItsNameOrIsAdded) {
  write("base.toml", base);
  const Case c =
      load_case(write("own.toml",
                      "extends = \"base.toml\"\n[[body]]\nname = \"rock\"\nposition = [\"1 m\", \"0 m\", "
                      "\"0 m\"]\n[[body]]\nname = \"other\"\ndiameter = \"1 mm\"\n"));
  ASSERT_EQ(c.bodies.size(), 2u);
  EXPECT_EQ(c.bodies[0].diameter, 10e-3);
  EXPECT_EQ(c.bodies[0].position.x(), 1.0);
  EXPECT_EQ(c.bodies[1].name, "other");
}

TEST_F(Extends, AnExpectationReplacesThatOfTheSameQuantity) {
  const std::string expect = "[[expect]]\nquantity = \"/steps\"\nat_least = ";
  write("base.toml", base + expect + "1\nsource = \"a\"\n");
  const Case c = load_case(write("own.toml", "extends = \"base.toml\"\n" + expect + "2\n"));
  ASSERT_EQ(c.expects.size(), 1u);
  EXPECT_EQ(c.expects[0].at_least, 2.0);
  EXPECT_EQ(c.expects[0].source, "a");
}

TEST_F(Extends, FilesLieBesideTheCaseThatNamesThem) {
  write("shared/parts/base.toml", base);
  write("shared/middle.toml", "extends = \"parts/base.toml\"\n");
  const Case c = load_case(write("own/own.toml", "extends = \"../shared/middle.toml\"\n"));
  EXPECT_EQ(std::filesystem::path(beside_case(c, c.walls[0].file)).lexically_normal(),
            scratch.path() / "shared/parts/floor.stl");
  const Case set = load_case(scratch.path() / "own/own.toml", {"wall.floor.file=own.stl"});
  EXPECT_EQ(std::filesystem::path(beside_case(set, set.walls[0].file)).lexically_normal(),
            scratch.path() / "own/own.stl");
}

TEST_F(Extends, TheFilesOfACaseAreThoseOfItsJetToo) {
  write("jets/base.toml", base);
  write("jets/jet.toml", "extends = \"base.toml\"\n");
  const Case c = load_case(write("own.toml",
                                 "[run]\nend_time = \"1 s\"\n[flow]\nsolver = \"none\"\n"
                                 "[jet]\nsource_case = \"jets/jet.toml\"\n[[body]]\ndiameter = \"1 mm\"\n"));
  std::vector<std::string> names;
  for (const std::string& file : files_of(c))
    names.push_back(std::filesystem::path(file).filename().string());
  EXPECT_EQ(names, (std::vector<std::string>{"base.toml", "floor.stl", "jet.toml"}));
}

TEST_F(Extends, AnErrorIsShownWhereItStands) {
  std::string bad = base;
  bad.replace(bad.find("0.5"), 3, "-2");
  const std::string file = write("base.toml", bad);
  const std::string said = error_of(write("own.toml", "extends = \"base.toml\"\n[run]\nend_tim = \"2 s\"\n"));
  EXPECT_THAT(said, HasSubstr(file + ":3: error: run.courant"));
  EXPECT_THAT(said, HasSubstr("own.toml:3: error: run.end_tim"));
  EXPECT_EQ(error_of(write("mended.toml", "extends = \"base.toml\"\n[run]\ncourant = 1\n")), "");
}

TEST_F(Extends, WhatCannotBeExtendedIsRefusedWithItsLine) {
  EXPECT_THAT(
      error_of(write("own.toml", "# mine\nextends = \"gone.toml\"\n")),
      HasSubstr("own.toml:2: error: extends: " + (scratch.path() / "gone.toml").string() + ": no such file"));
  EXPECT_THAT(error_of(write("own.toml", "extends = 3\n")), HasSubstr("the name of a file is needed"));
  EXPECT_THAT(error_of(write("own.toml", "extends = \"own.toml\"\n")), HasSubstr("a circle?"));
  EXPECT_THAT(error_of(write("own.toml", "extends = \".\"\n")), HasSubstr("is not a file"));
  write("empty.toml", "\n");
  EXPECT_THAT(error_of(write("own.toml", "extends = \"empty.toml\"\n")), HasSubstr("is empty"));
}

}  // namespace
}  // namespace ejecta
