#include "output/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "output/history.hpp"
#include "output/output_file.hpp"
#include "output/replay.hpp"
#include "output/report_plain.hpp"
#include "output/run_directory.hpp"
#include "output/verdict.hpp"
#include "scratch_directory.hpp"

using namespace ejecta;
using namespace ejecta::output;
using nlohmann::ordered_json;
using testing::HasSubstr;
using testing::Not;

namespace {

ReplayFrame frame_at(double time) {
  ReplayFrame frame;
  frame.time = time;
  frame.bodies = {BodyPose{Vec3(time, 0, 0.5), Quat(1, 0, 0, 0)}};
  frame.slices = {SliceFrame{0, 12.5, {0, 128, 255, 3}}};
  return frame;
}

ReplayHeader header() {
  ReplayHeader h;
  h.rasters = {{"y = 0", 1, 0.0, {0, 0}, {1, 1}, {2, 2}, false, false}};
  h.bodies = {{"cube", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}};
  return h;
}

RunDirectory small_run(const std::filesystem::path& path) {
  const RunDirectory run = RunDirectory::create(path, false);
  run.write_manifest({{"version", "1"}});
  run.write_case("# </script><b>&\n");
  run.write_result(
      {{"bodies", {{{"name", "cube"}, {"outcome", "ejected"}, {"clearance_at_splitter_m", 0.0123}}}},
       {"profile", {1, 2, 3, 4, 5, 6, 7}}});
  HistoryFile(run.history("body-cube"), {}, {{"x", "m"}}).add(0.0, std::vector{1.5});
  ReplayFile(run.replay(), header()).add(frame_at(0.0));
  return run;
}

}  // namespace

TEST(Replay, ResumedFileEqualsTheUninterruptedOne) {
  const ScratchDirectory dir;
  {
    ReplayFile whole(dir / "whole", header()), killed(dir / "killed", header());
    for (int n = 0; n < 6; ++n) whole.add(frame_at(0.1 * n));
    for (int n = 0; n < 4; ++n) killed.add(frame_at(0.1 * n));
  }
  LineFile(dir / "killed", read_file(dir / "killed").size()).append("{\"time\":0.4,\"bo");
  ReplayFile resumed(dir / "killed", 0.1 * 2);
  for (int n = 3; n < 6; ++n) resumed.add(frame_at(0.1 * n));
  EXPECT_EQ(read_file(dir / "killed"), read_file(dir / "whole"));
}

TEST(Replay, LinesAreJson) {
  const ScratchDirectory dir;
  ReplayFrame moment = frame_at(0.25);
  moment.bodies.push_back({});
  moment.bodies.back().there = false;
  { ReplayFile(dir / "r", header()).add(moment); }
  const auto lines = read_replay_lines(dir / "r");
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(ordered_json::parse(lines[0])["rasters"][0]["pixels"][1], 2);
  const auto frame = ordered_json::parse(lines[1]);
  EXPECT_EQ(frame["bodies"][0], ordered_json({0.25, 0, 0.5, 1, 0, 0, 0}));
  EXPECT_TRUE(frame["bodies"][1].is_null());
  EXPECT_EQ(frame["slices"][0]["full_scale"], 12.5);
}

TEST(Report, HoldsTheRunAndCannotBreakOutOfItsScript) {
  const ScratchDirectory dir;
  const RunDirectory run = small_run(dir / "a.run");
  const std::filesystem::path path = run.path();
  const std::string json = report_json(std::span(&path, 1));
  EXPECT_THAT(json, Not(HasSubstr("<")));
  const auto data = ordered_json::parse(json);
  EXPECT_EQ(data["runs"][0]["name"], "a.run");
  EXPECT_EQ(data["runs"][0]["case"], "# </script><b>&\n");
  EXPECT_EQ(data["runs"][0]["verdict"], "cube is ejected: its centre passes 12.3 mm above the plate's edge.");
  EXPECT_EQ(data["runs"][0]["history"]["body-cube"]["columns"][1]["unit"], "m");
  EXPECT_EQ(data["runs"][0]["replay"].size(), 2u);
  write_report(path);
  EXPECT_THAT(read_file(path / "report.html"),
              HasSubstr(report_page().empty() ? "plain report" : "id=\"app\""));
}

TEST(Report, TwoRunsAndARunWithoutResult) {
  const ScratchDirectory dir;
  small_run(dir / "a.run");
  RunDirectory::create(dir / "b.run", false).write_manifest({{"version", "1"}});
  const std::vector<std::filesystem::path> runs{dir / "a.run", dir / "b.run"};
  const auto data = ordered_json::parse(report_json(runs));
  EXPECT_EQ(data["runs"].size(), 2u);
  EXPECT_EQ(data["runs"][1]["verdict"], "This run is not finished.");
  EXPECT_TRUE(data["runs"][1]["result"].is_null());
}

TEST(Report, BytesThatAreNoTextDoNotCostTheReport) {
  const ScratchDirectory dir;
  const RunDirectory run = small_run(dir / "a.run");
  run.write_case("# f\xfcr die Mine\n");
  run.write_manifest({{"case", "f\xfcr.toml"}});
  EXPECT_NO_THROW(write_report(run.path()));
}

TEST(Report, WhatIsNotARunIsRefused) {
  const ScratchDirectory dir;
  EXPECT_THROW(write_report(dir.path()), InputError);
  EXPECT_THROW(write_report(dir / "missing"), InputError);
}

TEST(PlainReport, ShowsVerdictAndNumbers) {
  const ScratchDirectory dir;
  const std::filesystem::path path = small_run(dir / "a.run").path();
  const std::string html = plain_report(report_json(std::span(&path, 1)));
  EXPECT_THAT(html, HasSubstr("12.3 mm above"));
  EXPECT_THAT(html, HasSubstr("bodies/0/clearance_at_splitter_m</th><td>0.0123"));
  EXPECT_THAT(html, HasSubstr("profile</th><td>7 values"));
}

TEST(Verdict, SaysWhetherItIsWhatWasWanted) {
  const auto body = [](const char* name, const char* outcome, const char* judgement, double clearance) {
    return ordered_json{{"name", name},
                        {"outcome", outcome},
                        {"judgement", judgement},
                        {"clearance_at_splitter_m", clearance}};
  };
  const ordered_json right = body("ore", "ejected", "right", 0.02),
                     kept = body("sand", "not ejected", "right", -0.03),
                     by_catch = body("mud", "ejected", "by-catch", 0.01),
                     missed = body("gem", "not ejected", "missed", -0.02);
  const auto sentence = [](std::vector<ordered_json> list) {
    return verdict_sentence({{"bodies", std::move(list)}});
  };
  EXPECT_EQ(sentence({right}),
            "ore is right: ejected, as it should be; its centre passes 20.0 mm above the plate's edge.");
  EXPECT_EQ(sentence({kept}),
            "sand is right: not ejected, as it should be; its centre passes 30.0 mm below the plate's edge.");
  EXPECT_EQ(sentence({by_catch}),
            "mud is by-catch: ejected, and should not be; its centre passes 10.0 mm above the plate's edge.");
  EXPECT_EQ(sentence({missed}),
            "gem is missed: not ejected, and should be; its centre passes 20.0 mm below the plate's edge.");
  EXPECT_EQ(sentence({right, kept, by_catch, missed}),
            "Of 4 bodies 2 right (ore, sand), 1 by-catch (mud), 1 missed (gem).");
}

TEST(Verdict, OneSentenceForEveryKindOfRun) {
  const ordered_json missed{{"name", "a"},
                            {"outcome", "not ejected"},
                            {"clearance_at_splitter_m", -0.02},
                            {"velocity_margin_z_m_s", -0.25}};
  const ordered_json hit{{"name", "b"}, {"outcome", "ejected"}, {"velocity_margin_z_m_s", 0.1}};
  const auto bodies = [](std::vector<ordered_json> list) {
    return ordered_json{{"bodies", std::move(list)}};
  };
  EXPECT_EQ(verdict_sentence(bodies({missed})),
            "a is not ejected: its centre passes 20.0 mm below the plate's edge, 0.25 m/s of vertical "
            "velocity short "
            "of clearing it.");
  EXPECT_EQ(verdict_sentence(bodies({{{"name", "c"}, {"outcome", "undecided"}}})),
            "c is undecided: the time limit came before it reached the plate.");
  EXPECT_EQ(verdict_sentence(bodies({hit})), "b is ejected, with 0.10 m/s of vertical velocity to spare.");
  EXPECT_EQ(verdict_sentence(bodies({missed, hit})), "1 of 2 bodies is ejected: b.");
  EXPECT_EQ(verdict_sentence(bodies({missed, missed})), "0 of 2 bodies are ejected.");
  const ordered_json late{{"name", "c"}, {"outcome", "undecided"}};
  EXPECT_EQ(verdict_sentence(bodies({late, late})),
            "All 2 bodies are undecided, since the time limit came first.");
  ordered_json cut = bodies({hit, late});
  cut["simulated_time_s"] = 0.15;
  EXPECT_EQ(verdict_sentence(cut),
            "1 of 2 bodies is ejected: b; 1 undecided, since the time limit of 150 ms came first: c.");
  EXPECT_EQ(undecided_bodies(cut), std::vector<std::string>{"c"});
  EXPECT_EQ(verdict_sentence({{"simulated_time_s", 0.02}}), "Computed 20 ms.");
  EXPECT_EQ(verdict_sentence({{"expectations", {{{"pass", true}}, {{"pass", false}}}}}),
            "1 of 2 expected values met.");
}
