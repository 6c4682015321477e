#include "output/checkpoint.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <numeric>
#include <random>

#include "base/error.hpp"
#include "file_size_limit.hpp"
#include "output/output_file.hpp"
#include "scratch_directory.hpp"

using namespace ejecta;
using namespace ejecta::output;
using testing::HasSubstr;
namespace fs = std::filesystem;

namespace {

void write(const CheckpointStore& store, std::int64_t step) {
  CheckpointWriter writer = store.begin({1e-3 * static_cast<double>(step), step});
  std::vector<float> field(5000);
  std::iota(field.begin(), field.end(), static_cast<float>(step));
  writer.put("flow/velocity_x", std::span<const float>(field));
  writer.put("bodies", std::span<const double>(std::vector{1.0 / 3.0, -0.0, 5e-324}));
  writer.put("clock/steps", std::span<const std::int64_t>(std::vector<std::int64_t>{step}));
  writer.put("flags", std::span<const std::uint8_t>(std::vector<std::uint8_t>{1, 0, 255}));
  store.commit(writer);
}

std::string message_of(const auto& action) {
  try {
    action();
  } catch (const Error& e) {
    return e.what();
  }
  return "no error";
}

}  // namespace

TEST(Checkpoint, ValuesComeBackToTheSameBits) {
  const ScratchDirectory dir;
  const CheckpointStore store(dir.path());
  write(store, 7);
  const auto newest = store.newest();
  ASSERT_TRUE(newest.reader);
  const CheckpointReader& reader = *newest.reader;
  EXPECT_EQ(reader.at().step, 7);
  EXPECT_EQ(reader.at().time, 1e-3 * 7);
  std::vector<float> field(reader.size("flow/velocity_x"));
  reader.get("flow/velocity_x", std::span<float>(field));
  EXPECT_EQ(field[4999], 5006.0f);
  std::vector<double> bodies(3);
  reader.get("bodies", std::span<double>(bodies));
  EXPECT_EQ(bodies[0], 1.0 / 3.0);
  EXPECT_TRUE(std::signbit(bodies[1]));
  EXPECT_EQ(bodies[2], 5e-324);
  EXPECT_TRUE(reader.has("flow/velocity_x"));
  EXPECT_FALSE(reader.has("flow/velocity_y"));
  EXPECT_FALSE(reader.has("nowhere/at/all"));
}

TEST(Checkpoint, SameStateGivesTheSameFile) {
  const ScratchDirectory a, b;
  write(CheckpointStore(a.path()), 3);
  write(CheckpointStore(b.path()), 3);
  EXPECT_EQ(read_file(a / "step-000000003.h5"), read_file(b / "step-000000003.h5"));
}

TEST(Checkpoint, WrongNameTypeOrLengthIsNamed) {
  const ScratchDirectory dir;
  const CheckpointStore store(dir.path());
  write(store, 1);
  const CheckpointReader reader = *store.newest().reader;
  std::vector<double> d(3), d2(2);
  std::vector<float> f(3);
  EXPECT_THAT(message_of([&] { reader.get("none", std::span<double>(d)); }), HasSubstr("no array \"none\""));
  EXPECT_THAT(message_of([&] { reader.get("bodies", std::span<float>(f)); }), HasSubstr("another type"));
  EXPECT_THAT(message_of([&] { reader.get("bodies", std::span<double>(d2)); }),
              HasSubstr("3 values instead of 2"));
}

TEST(Checkpoint, TheLastTwoAreKept) {
  const ScratchDirectory dir;
  const CheckpointStore store(dir.path());
  for (const int step : {9, 10, 100}) write(store, step);
  EXPECT_FALSE(fs::exists(dir / "step-000000009.h5"));
  EXPECT_TRUE(fs::exists(dir / "step-000000010.h5"));
  EXPECT_EQ(store.newest().reader->at().step, 100);
}

TEST(Checkpoint, AnyDamageIsFoundAndTheOlderOneUsed) {
  const ScratchDirectory dir;
  const CheckpointStore store(dir.path());
  write(store, 1);
  write(store, 2);
  const std::string good = read_file(dir / "step-000000002.h5");
  std::mt19937 random(42);
  for (int trial = 0; trial < 300; ++trial) {
    std::string bad = good;
    if (trial % 3 == 0) bad.resize(random() % good.size());
    else if (trial % 3 == 1)
      // Bytes 80 to 511 belong to nobody.
      bad[trial % 2 ? random() % 80 : 512 + random() % (good.size() - 512)] ^=
          static_cast<char>(1 + random() % 255);
    else bad += "more";
    write_file(dir / "step-000000002.h5", bad);
    const auto newest = store.newest();
    ASSERT_TRUE(newest.reader) << trial;
    EXPECT_EQ(newest.reader->at().step, 1) << trial;
    ASSERT_EQ(newest.damaged.size(), 1u) << trial;
    EXPECT_THAT(newest.damaged[0], HasSubstr("step-000000002.h5"));
  }
}

TEST(Checkpoint, WithoutAnyThereIsNothing) {
  const ScratchDirectory dir;
  EXPECT_FALSE(CheckpointStore(dir.path()).newest().reader);
  EXPECT_FALSE(CheckpointStore(dir / "missing").newest().reader);
}

TEST(Checkpoint, AnUnfinishedOneLeavesNothing) {
  const ScratchDirectory dir;
  const CheckpointStore store(dir.path());
  {
    CheckpointWriter writer = store.begin({0.0, 5});
    writer.put("a", std::span<const double>(std::vector{1.0}));
  }
  EXPECT_TRUE(fs::is_empty(dir.path()));
}

TEST(Checkpoint, FullDiskIsAnErrorAndTheOlderOnesStay) {
  const ScratchDirectory dir;
  const CheckpointStore store(dir.path());
  write(store, 1);
  for (const rlim_t room : {100, 1000, 3000, 10000, 20000}) {
    testing::internal::CaptureStderr();
    const std::string message = message_of([&] {
      const FileSizeLimit limit(room);
      write(store, 2);
    });
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "HDF5 printed its error stack";
    EXPECT_THAT(message, HasSubstr("step-000000002.h5")) << room;
    EXPECT_FALSE(fs::exists(dir / "step-000000002.h5"));
    EXPECT_FALSE(fs::exists(dir / "step-000000002.h5.tmp"));
    EXPECT_EQ(store.newest().reader->at().step, 1);
  }
}

TEST(Checkpoint, UnwritablePlaceIsNamed) {
  EXPECT_THAT(message_of([] { CheckpointStore("/nonexistent").begin({0.0, 1}); }), HasSubstr("/nonexistent"));
}
