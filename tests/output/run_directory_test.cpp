#include "output/run_directory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "base/error.hpp"
#include "output/output_file.hpp"
#include "scratch_directory.hpp"

using namespace ejecta;
using namespace ejecta::output;
using testing::HasSubstr;

namespace {
std::string message_of(const auto& action) {
  try {
    action();
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}
}  // namespace

TEST(RunDirectory, NamedAfterTheCase) {
  EXPECT_EQ(directory_for("", "cases/paper/10mm-cubic.toml", "run"), "10mm-cubic.run");
  EXPECT_EQ(directory_for("", "./-cubic.toml", "study"), "./-cubic.study") << "a word of run-task";
  EXPECT_EQ(directory_for("-x", "cubic.toml", "run"), "./-x");
}

TEST(RunDirectory, IsNotOverwrittenWithoutForce) {
  const ScratchDirectory dir;
  const RunDirectory run = RunDirectory::create(dir / "a.run", false);
  run.write_manifest({{"version", "1"}});
  write_file(run.path() / "notes.txt", "mine");
  const std::string message = message_of([&] { RunDirectory::create(dir / "a.run", false); });
  EXPECT_THAT(message, HasSubstr("--force"));
  EXPECT_THAT(message, HasSubstr("--resume"));
  RunDirectory::create(dir / "a.run", true);
  EXPECT_FALSE(std::filesystem::exists(run.path() / "manifest.json"));
  EXPECT_EQ(read_file(run.path() / "notes.txt"), "mine");
}

TEST(RunDirectory, ForceDoesNotTouchADirectoryThatIsNotARun) {
  const ScratchDirectory dir;
  write_file(dir / "result.json", "somebody else's");
  EXPECT_THAT(message_of([&] { RunDirectory::create(dir.path(), true); }), HasSubstr("not of a run"));
  EXPECT_EQ(read_file(dir / "result.json"), "somebody else's");
}

TEST(RunDirectory, ARunKilledAtItsStartIsNotInTheWay) {
  const ScratchDirectory dir;
  RunDirectory::create(dir / "a.run", false);
  EXPECT_NO_THROW(RunDirectory::create(dir / "a.run", false));
  write_file(dir / "a.run/manifest.json.tmp", "{\"prog");
  EXPECT_NO_THROW(RunDirectory::create(dir / "a.run", false));
}

TEST(RunDirectory, FileInTheWayOrImpossiblePlaceIsNamed) {
  const ScratchDirectory dir;
  write_file(dir / "file", "");
  EXPECT_THAT(message_of([&] { RunDirectory::create(dir / "file", false); }), HasSubstr("is a file"));
  EXPECT_THAT(message_of([] { RunDirectory::create("/proc/ejecta.run", false); }),
              HasSubstr("/proc/ejecta.run"));
  EXPECT_THAT(message_of([&] { RunDirectory::open(dir.path()); }), HasSubstr("manifest.json"));
}

TEST(RunDirectory, NanBecomesNullAndIsTold) {
  const ScratchDirectory dir;
  const RunDirectory run = RunDirectory::create(dir / "a.run", false);
  nlohmann::ordered_json result{{"bodies", {{{"mean_force_N", {0.0, std::nan(""), 0.0}}}}}, {"steps", 7}};
  try {
    run.write_result(result);
    FAIL() << "NaN was not told";
  } catch (const DivergedError& e) {
    EXPECT_THAT(e.what(), HasSubstr("/bodies/0/mean_force_N/1"));
  }
  std::ifstream file(run.path() / "result.json");
  const auto written = nlohmann::json::parse(file);  // and what the run found besides is not lost
  EXPECT_TRUE(written["bodies"][0]["mean_force_N"][1].is_null());
  EXPECT_EQ(written["steps"], 7);
}

TEST(Manifest, SaysWhereAndByWhat) {
  const auto manifest = make_manifest({"ejecta run x.toml", "x.toml", "abc", 2});
  EXPECT_EQ(manifest["input_sha256"], "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(manifest["threads"], 2);
  for (const char* key : {"version", "git_revision", "compiler", "compile_flags", "precision", "started"})
    EXPECT_THAT(manifest[key].get<std::string>(), testing::Not(testing::IsEmpty())) << key;
  EXPECT_GT(manifest["machine"]["memory_bytes"].get<std::int64_t>(), 1 << 20);
}
