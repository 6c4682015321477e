#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/error.hpp"
#include "case/load.hpp"

using namespace ejecta;
using testing::HasSubstr;

/// Every file of tests/bad_cases is refused with the words of its "# expect:" lines, the file and a line.
namespace {

std::vector<std::string> bad_cases() {
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::directory_iterator(EJECTA_SOURCE_DIR "/tests/bad_cases"))
    if (entry.path().extension() == ".toml") paths.push_back(entry.path().string());
  std::sort(paths.begin(), paths.end());
  return paths;
}

std::vector<std::string> expected_words(const std::string& path) {
  const std::string mark = "# expect: ";
  std::vector<std::string> words;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line) && line.starts_with(mark);)
    words.push_back(line.substr(mark.size()));
  return words;
}

std::string message_of(const std::string& path) {
  try {
    load_case(path);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

class BadCase : public testing::TestWithParam<std::string> {};

TEST_P(BadCase, IsRefusedWithItsMessage) {
  const std::vector<std::string> words = expected_words(GetParam());
  ASSERT_FALSE(words.empty()) << "no '# expect:' line";
  const std::string message = message_of(GetParam());
  ASSERT_NE(message, "") << "was accepted";
  for (const std::string& word : words) EXPECT_THAT(message, HasSubstr(word));
  EXPECT_THAT(message, HasSubstr(GetParam() + ":")) << "says where";
  EXPECT_THAT(message, HasSubstr("^")) << "shows the line with a caret";
}

INSTANTIATE_TEST_SUITE_P(AllFiles, BadCase, testing::ValuesIn(bad_cases()),
                         [](const auto& info) { return std::filesystem::path(info.param).stem().string(); });

TEST(BadCases, ThereAreEnough) { EXPECT_GE(bad_cases().size(), 60u); }

}  // namespace
