#include "study/study.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "base/error.hpp"
#include "case/load.hpp"
#include "scratch_directory.hpp"
#include "study/perform.hpp"

namespace ejecta {
namespace {

using testing::HasSubstr;

constexpr const char* kBall = R"([run]
title = "a ball falls"
end_time = "10 ms"
[flow]
solver = "none"
[[body]]
name = "ball"
diameter = "10 mm"
)";

class Studies : public testing::Test {
 protected:
  std::string write(const std::string& study, const std::string& text = kBall) {
    const std::string path = (folder_ / "case.toml").string();
    std::ofstream(path) << text << study;
    return path;
  }
  StudySetup set_up(const std::string& study) {
    const std::string path = write(study);
    return set_up_study(case_tree(path), load_case(path));
  }
  std::string refusal(const std::string& study) {
    try {
      set_up(study);
    } catch (const InputError& e) {
      return e.what();
    }
    return "was accepted";
  }
  TaskStore store(const std::string& study, bool force = false) {
    const StudySetup setup = set_up(study);
    TaskStore s = TaskStore::create(folder_ / "s", setup.header, force);
    s.add(setup.tasks);
    return s;
  }
  ScratchDirectory folder_;
};

constexpr const char* kGrid = R"(
[study]
quantities = ["/weight_N"]
keep_runs = false
[[study.vary]]
key = "body.ball.diameter"
values = ["10 mm", "20 mm"]
[[study.vary]]
key = "environment.gravity"
from = ["0 m/s2", "0 m/s2", "-9.81 m/s2"]
to = ["0 m/s2", "0 m/s2", "-1.62 m/s2"]
steps = 3
)";

/// Stands for a run: what it tells follows from the case.
RunAnswer weigh(const Case& c, const RunRequest&) {
  if (c.bodies[0].diameter > 15e-3 && c.environment.gravity.z() < -9.0) throw DivergedError("too heavy");
  return {.stopped = false,
          .quantities = {{"weight_N", c.bodies[0].diameter * -c.environment.gravity.z()}},
          .wall_time = 1.0};
}

TEST_F(Studies, GridTakesEveryValueWithEveryOther) {
  const StudySetup setup = set_up(kGrid);
  ASSERT_EQ(setup.tasks.size(), 6u);
  EXPECT_EQ(setup.tasks[0].labels["body.ball.diameter"], 10e-3);
  EXPECT_EQ(setup.tasks[1].resolved.environment.gravity.z(), 0.5 * (-9.81 - 1.62));
  EXPECT_EQ(setup.tasks[5].resolved.bodies[0].diameter, 20e-3);
  EXPECT_EQ(setup.header["keys"][0]["unit"], "m");
}

TEST_F(Studies, ListTakesTheFirstValuesTogether) {
  const StudySetup setup = set_up(R"([study]
design = "list"
[[study.vary]]
key = "body.0.diameter"
values = ["10 mm", "20 mm"]
[[study.vary]]
key = "run.end_time"
values = ["1 ms", "2 ms"]
)");
  ASSERT_EQ(setup.tasks.size(), 2u);
  EXPECT_EQ(setup.tasks[1].resolved.run.end_time, 2e-3);
  EXPECT_EQ(setup.tasks[1].resolved.bodies[0].diameter, 20e-3);
}

TEST_F(Studies, SamplesStayWithinTheRange) {
  const StudySetup setup = set_up(R"([study]
design = "latin-hypercube"
samples = 10
[[study.vary]]
key = "material.0.density"
from = "2000 kg/m3"
to = "4000 kg/m3"
[[study.vary]]
key = "body.0.copies"
from = 2
to = 4
[[material]]
name = "ore"
)");
  ASSERT_EQ(setup.tasks.size(), 10u);
  double sum = 0.0;
  for (const NewTask& task : setup.tasks) {
    sum += task.resolved.materials[0].density / 10.0;
    EXPECT_GE(task.resolved.bodies[0].copies, 2);
    EXPECT_LE(task.resolved.bodies[0].copies, 4);
  }
  EXPECT_NEAR(sum, 3000.0, 100.0);
}

TEST_F(Studies, WhatIsWrongIsToldBeforeTheFirstRunWithItsPlace) {
  const std::string list = R"([[study.vary]]
key = "body.ball.diameter"
values = ["10 mm", "-3 mm", "20 mm"]
)";
  EXPECT_THAT(refusal(list), HasSubstr("case.toml:11: error: body.0.diameter: \"-3 mm\" is out of range"));
  EXPECT_THAT(refusal(list), HasSubstr("^~~~~~~"));
  EXPECT_THAT(refusal("[[study.vary]]\nkey = \"body.ball.diametre\"\nvalues = [1]\n"),
              testing::AllOf(HasSubstr("case.toml:10: error: study.vary.0.key: there is no key"),
                             HasSubstr("nearest:  body.ball.diameter"), HasSubstr("^")));
  EXPECT_THAT(refusal("[[study.vary]]\nkey = \"run.title\"\nvalues = [\"a\"]\n"), HasSubstr("may not vary"));
  EXPECT_THAT(refusal("[[study.vary]]\nkey = \"output.report\"\nvalues = [true]\n"),
              HasSubstr("may not vary"));
  EXPECT_THAT(refusal("[[study.vary]]\nkey = \"run.end_time\"\n"), HasSubstr("neither values nor a range"));
  EXPECT_THAT(refusal("[[study.vary]]\nkey = \"run.end_time\"\nfrom = \"1 ms\"\nto = \"9 ms\"\n"),
              HasSubstr("study.vary.0.steps"));
  EXPECT_THAT(refusal("[[study.vary]]\nkey = \"body.ball.shape\"\nfrom = \"box\"\nto = \"sphere\"\n"),
              HasSubstr("has no range"));
  EXPECT_THAT(refusal("[study]\nquantities = [\"outcome\"]\n[[study.vary]]\nkey = \"run.end_time\"\nvalues = "
                      "[\"1 ms\"]\n"),
              HasSubstr("is no JSON pointer"));
  EXPECT_THAT(
      refusal("[study]\ndesign = \"sobol\"\n[[study.vary]]\nkey = \"run.end_time\"\nfrom = \"1 ms\"\nto "
              "= \"9 ms\"\n"),
      HasSubstr("study.samples"));
  EXPECT_THAT(refusal("[[study.vary]]\nkey = \"body.0.diameter\"\nvalues = [\"5 mm\", \"5.0 mm\"]\n"),
              HasSubstr("two runs of the study are the same"));
  EXPECT_THAT(refusal("[study]\ndesign = \"sobol\"\nsamples = 1000000\n[[study.vary]]\nkey = "
                      "\"body.0.diameter\"\nfrom = \"5 mm\"\nto = \"9 mm\"\n"),
              HasSubstr("a study of 1000000 runs"));
  EXPECT_THAT(refusal("[study]\nquantities = [\"/bodies/99999999999999999999/x\"]\n[[study.vary]]\nkey = "
                      "\"run.end_time\"\nvalues = [\"1 ms\"]\n"),
              HasSubstr("no JSON pointer"));
  EXPECT_THAT(refusal("[study]\n"), HasSubstr("nothing varies"));
  EXPECT_THAT(refusal(""), HasSubstr("has no [study]"));
}

TEST_F(Studies, TheTableHasEveryRunWithItsState) {
  const TaskStore s = store(kGrid);
  for (std::size_t n = 0; n < 5; ++n) perform_task(s, n, 1, weigh, {});
  const auto result = study_result(s);
  ASSERT_EQ(result["runs"].size(), 6u);
  EXPECT_EQ(result["runs"][0]["state"], "done");
  EXPECT_EQ(result["runs"][0]["body.ball.diameter"], 10e-3);
  EXPECT_NEAR(result["runs"][0]["/weight_N"], 0.0981, 1e-12);
  EXPECT_EQ(result["runs"][3]["state"], "diverged");
  EXPECT_EQ(result["runs"][3]["reason"], "too heavy");
  EXPECT_EQ(result["runs"][5]["state"], "waiting");
  const std::string table = study_table(result);
  EXPECT_THAT(table,
              testing::StartsWith(
                  "run,state,body.ball.diameter [m],environment.gravity.x [m/s2],environment.gravity.y "
                  "[m/s2],environment.gravity.z [m/s2],/weight_N,reason\n"
                  "1,done,0.01,0.0,0.0,-9.81,0.0981,\n"));
  EXPECT_THAT(status_line(study_status(s)), HasSubstr("4 of 6 runs done, 1 failed"));
}

TEST_F(Studies, ATaskIsRunOnce) {
  const TaskStore s = store(kGrid);
  int runs = 0;
  const RunFunction counted = [&](const Case& c, const RunRequest& r) {
    ++runs;
    EXPECT_EQ(perform_task(s, 0, 1, weigh, {}), Performed::runs_elsewhere);
    EXPECT_EQ(s.state(0), TaskState::running);
    return weigh(c, r);
  };
  EXPECT_EQ(perform_task(s, 0, 1, counted, {}), Performed::done);
  EXPECT_EQ(perform_task(s, 0, 1, counted, {}), Performed::was_done);
  EXPECT_EQ(runs, 1);
  EXPECT_EQ(s.state(0), TaskState::done);
}

TEST_F(Studies, OneProcessDecidesWhatIsRunNext) {
  const TaskStore s = store(kGrid);
  {
    const StudyDriver one(s);
    EXPECT_THROW(StudyDriver two(s), InputError);
  }
  EXPECT_NO_THROW(StudyDriver three(s));
}

TEST_F(Studies, ATaskThatWasStoppedWaits) {
  const TaskStore s = store(kGrid);
  const RunFunction stopped = [](const Case&, const RunRequest&) { return RunAnswer{.stopped = true}; };
  EXPECT_EQ(perform_task(s, 1, 1, stopped, {}), Performed::stopped);
  EXPECT_EQ(s.state(1), TaskState::waiting);
}

TEST_F(Studies, TheSameStudyGoesOnAndAnotherIsRefused) {
  const TaskStore first = store(kGrid);
  perform_task(first, 2, 1, weigh, {});
  const TaskStore again = store(kGrid);
  EXPECT_EQ(again.states()[2], TaskState::done);
  const std::string other = std::string(kGrid) + "[contact]\ntime_step_fraction = 0.2\n";
  EXPECT_THROW(store(other), InputError);
  EXPECT_EQ(store(other, true).states()[2], TaskState::waiting);
}

TEST_F(Studies, EveryRunIsAnotherOne) {
  EXPECT_THROW(store("[[study.vary]]\nkey = \"body.0.diameter\"\nvalues = [\"10 mm\", \"1 cm\"]\n"
                     "[[study.vary]]\nkey = \"run.end_time\"\nvalues = [\"1 ms\", \"2 ms\"]\n"),
               InputError);
}

TEST_F(Studies, ACaseThatWasChangedIsRefused) {
  const TaskStore s = store(kGrid);
  const auto path = s.path() / "cases" / (s.tasks()[0].hash + ".toml");
  std::ofstream(path, std::ios::app) << "\n[contact]\ntime_step_fraction = 0.2\n";
  EXPECT_THROW(s.case_of(0), InputError);
  EXPECT_NO_THROW(s.case_of(1));
  EXPECT_EQ(perform_task(s, 0, 1, weigh, {}), Performed::refused);
}

}  // namespace
}  // namespace ejecta
