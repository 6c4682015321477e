#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "base/error.hpp"
#include "case/extent.hpp"
#include "case/load.hpp"
#include "case/words.hpp"
#include "jet/analysis.hpp"
#include "jet/computed.hpp"
#include "jet/measured.hpp"
#include "jet/model.hpp"
#include "jet/settled.hpp"
#include "jet/store.hpp"
#include "output/build_info.hpp"
#include "scratch_directory.hpp"
#include "small_jet.hpp"

using namespace ejecta;
using testing::HasSubstr;
namespace fs = std::filesystem;

namespace {

Case small_case(const std::string& more = "") { return parse_case(test::small_jet(more), "small jet"); }

class Folder : public testing::Test {
 protected:
  void SetUp() override { setenv("EJECTA_CACHE", folder.c_str(), 1); }
  void TearDown() override { unsetenv("EJECTA_CACHE"); }
  fs::path file(const std::string& text) {
    std::ofstream(folder / "measured.csv") << text;
    return folder / "measured.csv";
  }
  ScratchDirectory scratch;
  fs::path folder = scratch.path();
};

using JetStore = Folder;
using Measured = Folder;

TEST_F(JetStore, TheSecondTimeTheJetIsReadNotComputed) {
  std::vector<std::string> notes;
  const auto note = [&](const std::string& line) { notes.push_back(line); };
  const JetProfile computed = stored_or_computed_jet(small_case(), 10e-3, note);
  ASSERT_EQ(notes.size(), 1u);
  const JetProfile read = stored_or_computed_jet(small_case(), 10e-3, note);
  EXPECT_EQ(notes.size(), 1u);
  EXPECT_EQ(read.at({1e-3, 0, 0}, 1e-4).velocity.z(), computed.at({1e-3, 0, 0}, 1e-4).velocity.z());
}

TEST_F(JetStore, ADamagedOrHalfWrittenJetIsNamedAndComputedAgain) {
  const Case c = small_case();
  const fs::path stored = jet_file(c, 10e-3);
  const auto size_after = [&](const auto& damage) {
    stored_or_computed_jet(c, 10e-3, [](const std::string&) {});
    const auto whole = fs::file_size(stored);
    damage();
    std::string all;
    stored_or_computed_jet(c, 10e-3, [&](const std::string& line) { all += line + '\n'; });
    EXPECT_THAT(all, HasSubstr("is damaged"));
    EXPECT_THAT(all, HasSubstr(stored.string()));
    EXPECT_EQ(fs::file_size(stored), whole);
  };
  size_after([&] { fs::resize_file(stored, fs::file_size(stored) / 2); });
  size_after([&] {
    std::fstream f(stored, std::ios::in | std::ios::out | std::ios::binary);
    f.seekp(500);
    f.put('x');
  });
}

TEST_F(JetStore, TitleAndOutputsDoNotMatterTheValveDoes) {
  EXPECT_EQ(jet_file(small_case(), 10e-3), jet_file(small_case("[output]\nreport = false\n"), 10e-3));
  Case other = small_case();
  other.valve.supply_pressure *= 1.01;
  EXPECT_NE(jet_file(small_case(), 10e-3), jet_file(other, 10e-3));
  EXPECT_NE(jet_file(small_case(), 10e-3), jet_file(small_case(), 9e-3));
}

TEST_F(JetStore, ATraceCountsByWhatItSays) {
  Case c = small_case();
  c.path = (folder / "jet.toml").string();
  c.valve.shape = ValveShape::trace;
  c.valve.trace = "opening.csv";
  const auto name_with = [&](const std::string& trace) {
    std::ofstream(folder / "opening.csv") << trace;
    return jet_file_name(c, 10e-3);
  };
  const std::string name = name_with("0,0\n1e-4,1\n");
  EXPECT_NE(name, name_with("0,0\n2e-4,1\n"));
  EXPECT_EQ(name, name_with("0,0\n1e-4,1\n"));
}

TEST_F(JetStore, AJetBesideItsCaseIsReadAndLeftAlone) {
  Case c = small_case();
  c.path = (folder / "case" / "jet.toml").string();
  JetProfile beside(10e-3, {0.0, 1e-3});
  beside.add({.time = 0.0, .axial = {123.0, 0.0}, .radial = {0, 0}, .k = {0, 0}, .epsilon = {0, 0}});
  const fs::path file = shipped_jet_file(c, 10e-3);
  beside.write(file);
  const auto fastest = [&] {
    return stored_or_computed_jet(c, 10e-3, [](const std::string&) {}).fastest(0.0);
  };
  EXPECT_EQ(fastest(), 123.0);
  EXPECT_FALSE(fs::exists(jet_file(c, 10e-3)));
  fs::resize_file(file, fs::file_size(file) - 8);
  EXPECT_NE(fastest(), 123.0);
  EXPECT_TRUE(fs::exists(jet_file(c, 10e-3)));
}

// Else the first run of a paper case would compute its jet for minutes. When this fails, store the jet anew
// as cases/paper/jets/README.md says.
TEST(PaperJet, ComesWithItsCases) {
  if (sizeof(Real) != sizeof(float)) GTEST_SKIP() << "the stored jet is that of the float build";
  int fed = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(EJECTA_SOURCE_DIR) / "cases" / "paper")) {
    if (entry.path().extension() != ".toml") continue;
    const Case box = load_case(entry.path().string());
    if (box.jet.kind != JetKind::computed) continue;
    const fs::path file = shipped_jet_file(computed_jet_case(box), jet_height(box));
    ASSERT_TRUE(fs::exists(file)) << entry.path() << " asks for " << file;
    EXPECT_GT(JetProfile::read(file).fastest(7e-3), 100.0);
    ++fed;
  }
  EXPECT_GE(fed, 8);
}

TEST(JetModel, RefusesAnOrificeThatIsNotTheValves) {
  Case c = small_case();
  c.valve.orifice_diameter = 2e-3;
  EXPECT_THROW(JetModel{c}, InputError);
  c = small_case();
  c.boundary[4].patches.clear();
  EXPECT_THROW(JetModel{c}, InputError);
}

// Both leave the orifice with the momentum of the exact nozzle, whatever the case calls y.
TEST(JetModel, CompressibleAndIncompressibleLeaveWithTheSameMomentum) {
  for (const double discharge : {1.0, 0.64}) {
    std::string text = test::small_jet();
    for (std::size_t at = 0; discharge < 1.0 && (at = text.find("0.9 mm", at)) != std::string::npos;)
      text.replace(at, 6, "0.72 mm");
    Case c = parse_case(text, "small jet", {fmt::format("valve.discharge_coefficient={}", discharge)});
    const double exact = nozzle_thrust(nozzle_exit(Gas{}, 801325.0, 298.15, 101325.0), discharge, 1.8e-3);
    for (const Case& each : {c, incompressible_jet(c)}) {
      JetModel jet(each);
      for (Clock clock = jet.clock(); jet.time() < 0.09e-3;) jet.step(clock);
      EXPECT_NEAR(jet.orifice_flow().momentum / exact, 1.0, 0.03) << discharge;
    }
  }
}

TEST(Sweep, FindsWhereASquareReachesAValue) {
  const std::vector<double> u{600, 700, 900}, p{3.6e3, 4.9e3, 8.1e3};
  EXPECT_NEAR(where_square_reaches(u, p, 6.4e3), 800, 1e-9);
  EXPECT_NEAR(where_square_reaches(u, p, 10e3), 1000, 1e-9);
  EXPECT_NEAR(where_square_reaches(u, p, 2.5e3), 500, 1e-9);
}

TEST_F(Measured, IsReadInItsUnitsAndCompared) {
  const MeasuredCurve m =
      read_measured(file("# pitot\nz [mm],p [kPa]\n10, 2\n20, 4\n90, 1\n"), Dimension::length);
  ASSERT_EQ(m.x.size(), 3u);
  EXPECT_DOUBLE_EQ(m.x[1], 0.02);
  EXPECT_DOUBLE_EQ(m.y[1], 4000.0);
  const std::vector<double> x{0.0, 0.01, 0.05}, y{0.0, 2100.0, 6100.0};
  const MeasuredError e = compare_measured(m, x, y);
  EXPECT_EQ(e.points, 2);             // the third lies beyond the computed stretch
  EXPECT_NEAR(e.mean, -400.0, 1e-9);  // 100 and -900
  EXPECT_NEAR(e.largest, 900.0, 1e-9);
  EXPECT_DOUBLE_EQ(e.scale, 4000.0);
}

TEST_F(Measured, BadRowsAreRefusedWithTheirLine) {
  const auto refusal = [&](const std::string& text) {
    try {
      read_measured(file(text), Dimension::length);
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_THAT(refusal("z,p\n1,2\n"), HasSubstr("measured.csv:1: error: the column \"z\" has no unit"));
  EXPECT_THAT(refusal("z [ms],p [kPa]\n"), HasSubstr("\"ms\" is no unit of a length"));
  EXPECT_THAT(refusal("z [mm],p [kPa]\n1,2\n3\n"),
              HasSubstr("measured.csv:3: error: 1 values for 2 columns"));
  EXPECT_THAT(refusal("z [mm],p [kPa]\n3,2\n1,2\n"), HasSubstr("does not increase"));
  EXPECT_THAT(refusal("z [mm],p [kPa]\n"), HasSubstr("needs at least two rows"));
}

/// A jet on its axis that gets faster up to `place`, where it meets a shock with `jump` times the pressure
/// rise of a normal one, spread over the cell in which it stands and the next as conservation asks.
Centreline shocked(double place, double jump) {
  const double width = 0.1;
  Centreline line;
  for (int n = 0; n < 100; ++n) {
    const double z = width * (n + 0.5), mach = 1.0 + std::min(z, place);
    const double ahead = 10.0, behind = ahead * jump * gas_normal_shock_ratio(Gas{}, 1.0 + place);
    const double share = std::clamp((z + 0.5 * width - place) / width, 0.0, 1.0);
    JetSample s;
    s.mach = share > 0.0 ? 0.5 : mach;
    s.pressure = ahead + share * (behind - ahead);
    line.z.push_back(z);
    line.samples.push_back(s);
  }
  return line;
}

TEST(ShockStructure, FindsASmearedShockWithinItsCell) {
  for (const double place : {2.3, 2.33, 2.37, 2.4}) {
    const ShockStructure found = shock_structure(shocked(place, 1.0), Gas{});
    EXPECT_NEAR(found.mach_disk, place, 1e-9);
    EXPECT_NEAR(found.behind_over_normal_shock, 1.0, 0.1);
  }
  EXPECT_NEAR(shock_structure(shocked(2.3, 2.0), Gas{}).behind_over_normal_shock, 2.0, 0.1);
}

}  // namespace
