#include "output/output_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.hpp"
#include "file_size_limit.hpp"
#include "scratch_directory.hpp"

using namespace ejecta;
using namespace ejecta::output;
using testing::HasSubstr;

namespace {

std::string message_of(const auto& action) {
  try {
    action();
  } catch (const Error& e) {
    return e.what();
  }
  return "no error";
}

}  // namespace

TEST(OutputFile, AppearsOnlyWhenCommitted) {
  const ScratchDirectory dir;
  write_file(dir / "a", "old");
  {
    OutputFile file(dir / "a");
    file.write("new");
    EXPECT_EQ(read_file(dir / "a"), "old");
  }
  EXPECT_EQ(read_file(dir / "a"), "old");
  EXPECT_FALSE(std::filesystem::exists(dir / "a.tmp"));
  write_file(dir / "a", "new");
  EXPECT_EQ(read_file(dir / "a"), "new");
}

TEST(OutputFile, FullDiskIsAnErrorAndTheOldFileStays) {
  const ScratchDirectory dir;
  write_file(dir / "a", "old");
  const std::string message = message_of([&] {
    const FileSizeLimit limit(1000);
    write_file(dir / "a", std::string(5000, 'x'));
  });
  EXPECT_THAT(message, HasSubstr("cannot write"));
  EXPECT_THAT(message, HasSubstr((dir / "a").string()));
  EXPECT_EQ(read_file(dir / "a"), "old");
  EXPECT_FALSE(std::filesystem::exists(dir / "a.tmp"));
}

TEST(OutputFile, FullDeviceNamesTheReasonAndTheWayOn) {
  // /dev/full refuses every write with "No space left on device".
  const std::string message = message_of([] {
    LineFile file("/dev/full");
    file.append("x\n");
  });
  EXPECT_THAT(message, HasSubstr("No space left on device (free some space"));
  EXPECT_THAT(message, HasSubstr("/dev/full"));
}

TEST(OutputFile, MissingDirectoryIsNamed) {
  EXPECT_THAT(message_of([] { write_file("/nonexistent/a", "x"); }), HasSubstr("/nonexistent/a"));
}

TEST(LineFile, RemovedWhileRunningIsAnError) {
  const ScratchDirectory dir;
  LineFile file(dir / "a");
  file.append("1\n");
  std::filesystem::remove(dir / "a");
  EXPECT_THAT(message_of([&] { file.append("2\n"); }), HasSubstr("was removed while the run was going"));
}

TEST(LineFile, GoesOnAfterTheKeptPart) {
  const ScratchDirectory dir;
  { LineFile(dir / "a").append("1\n2\n3\n"); }
  { LineFile(dir / "a", 4).append("x\n"); }
  EXPECT_EQ(read_file(dir / "a"), "1\n2\nx\n");
}
