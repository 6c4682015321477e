#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/error.hpp"
#include "case/load.hpp"

using namespace ejecta;
using testing::HasSubstr;
namespace fs = std::filesystem;

/// Files that are no case at all.
namespace {

class OddFile : public testing::Test {
 protected:
  fs::path folder = fs::path(testing::TempDir()) / ("ejecta-odd-files-" + std::to_string(getpid()));
  void SetUp() override { fs::create_directories(folder); }
  void TearDown() override { fs::remove_all(folder); }

  std::string refusal(const fs::path& path) {
    try {
      load_case(path.string());
    } catch (const InputError& e) {
      return e.what();
    }
    return "accepted";
  }
  fs::path file(const std::string& content) {
    std::ofstream(folder / "x.toml", std::ios::binary) << content;
    return folder / "x.toml";
  }
};

TEST_F(OddFile, Missing) { EXPECT_THAT(refusal(folder / "nowhere.toml"), HasSubstr("no such file")); }
TEST_F(OddFile, Directory) { EXPECT_THAT(refusal(folder), HasSubstr("is a directory")); }
TEST_F(OddFile, Empty) { EXPECT_THAT(refusal(file("")), HasSubstr("is empty")); }
TEST_F(OddFile, OnlyBlanks) { EXPECT_THAT(refusal(file(" \n\t\n")), HasSubstr("is empty")); }
TEST_F(OddFile, OnlyComments) {
  EXPECT_THAT(refusal(file("# nothing\n")), HasSubstr("run.end_time: missing"));
}
TEST_F(OddFile, Binary) {
  EXPECT_THAT(refusal(file(std::string("\x7f"
                                       "ELF\x02\x01\0\0",
                                       8))),
              HasSubstr("is not a text file"));
}
TEST_F(OddFile, NotUtf8) {
  EXPECT_THAT(refusal(file("[run]\ntitle = \"\xff\xfe\"\n")), HasSubstr("x.toml:2: error"));
}
TEST_F(OddFile, Truncated) {
  EXPECT_THAT(refusal(file("[run]\nend_time = \"1 s\"\n[grid.x]\npoints = [\"0 m\", \"1")),
              HasSubstr("x.toml:4: error: not TOML"));
}

TEST_F(OddFile, Huge) {
  EXPECT_THAT(refusal(file(std::string(5 << 20, '#'))), HasSubstr("larger than 1 MiB"));
}

TEST_F(OddFile, HugeSpecialFileIsNotReadToItsEnd) {
  EXPECT_THAT(refusal("/dev/zero"), HasSubstr("larger than 1 MiB"));
}

TEST_F(OddFile, Unreadable) {
  const fs::path path = file("[run]\n");
  fs::permissions(path, fs::perms::none);
  if (std::ifstream(path)) {
    // root reads everything: what is left to refuse is the content
    EXPECT_THAT(refusal(path), HasSubstr("run.end_time: missing"));
  } else {
    EXPECT_THAT(refusal(path), HasSubstr("cannot be read"));
  }
}

TEST_F(OddFile, WindowsLineEndingsAndByteOrderMarkAreFine) {
  const fs::path path = file(
      "\xef\xbb\xbf[run]\r\nend_time = \"1 s\"\r\n[flow]\r\nsolver = \"none\"\r\n[[body]]\r\ndiameter = \"1 "
      "mm\"\r\n");
  EXPECT_EQ(load_case(path.string()).run.end_time, 1.0);
}

TEST_F(OddFile, ManyElementsAreReadInReasonableTime) {
  std::string text =
      "[run]\nend_time = \"1 s\"\n[flow]\nsolver = \"none\"\n[[body]]\nshape = \"multisphere\"\nspheres = "
      "[\n";
  for (int n = 0; n < 20000; ++n)
    text.append("[\"").append(std::to_string(n)).append(" mm\", \"0 mm\", \"0 mm\", \"5 mm\"],\n");
  EXPECT_EQ(load_case(file(text + "]\n").string()).bodies.at(0).spheres.size(), 20000u);
}

TEST_F(OddFile, AFileFullOfErrorsIsRefusedQuicklyAndBriefly) {
  std::string keys = "[run]\n", list = "[run]\nend_time = \"1 s\"\n[valve]\nmore_pulses = [", lines;
  for (int n = 0; n < 20000; ++n) {
    keys.append("k").append(std::to_string(n)).append(" = 1\n");
    list += "1,";
    lines += "what is this\n";
  }
  for (const std::string& text : {keys, list + "]\n", lines}) {
    const std::string message = refusal(file(text));
    EXPECT_THAT(message, HasSubstr("error: "));
    EXPECT_LT(message.size(), 100000u);
  }
}

TEST_F(OddFile, EndlessDottedKeysAreRefusedBeforeTheyAreParsed) {
  std::string key = "a";
  for (int n = 0; n < 400000; ++n) key += ".a";
  EXPECT_THAT(refusal(file(key + " = 1\n")), HasSubstr("nested too deeply"));
  EXPECT_THAT(refusal(file("[" + key + "]\n")), HasSubstr("nested too deeply"));
}

TEST_F(OddFile, ControlCharactersDoNotReachTheTerminal) {
  EXPECT_THAT(refusal(file("[run]\n\"\\u001b[31m\" = 1\n")), testing::Not(HasSubstr("\x1b")));
}

}  // namespace
