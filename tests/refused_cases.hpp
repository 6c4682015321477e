#pragma once
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "base/error.hpp"

/// Files of wrong cases, each beginning with "# expect:" lines of words that its refusal must hold.
namespace refused {

inline std::vector<std::string> files(const std::string& folder) {
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::directory_iterator(EJECTA_SOURCE_DIR "/tests/" + folder))
    if (entry.path().extension() == ".toml") paths.push_back(entry.path().string());
  std::sort(paths.begin(), paths.end());
  return paths;
}

inline std::string name_of(const testing::TestParamInfo<std::string>& info) {
  return std::filesystem::path(info.param).stem().string();
}

/// `load`: what must throw for the path.
template <class Load>
void expect_refusal(const std::string& path, const Load& load) {
  const std::string mark = "# expect: ";
  std::vector<std::string> words;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line) && line.starts_with(mark);)
    words.push_back(line.substr(mark.size()));
  ASSERT_FALSE(words.empty()) << "no '# expect:' line";
  std::string message;
  try {
    load(path);
  } catch (const ejecta::InputError& e) {
    message = e.what();
  }
  ASSERT_NE(message, "") << "was accepted";
  for (const std::string& word : words) EXPECT_THAT(message, testing::HasSubstr(word));
  // In the case, or in a table beside it.
  EXPECT_THAT(message, testing::ContainsRegex("\\.(toml|csv):[0-9]+: error")) << "says where";
  EXPECT_THAT(message, testing::HasSubstr("^")) << "shows the line with a caret";
  EXPECT_THAT(message, testing::HasSubstr("\n  expected: ")) << "says what would be right";
  EXPECT_THAT(message, testing::ContainsRegex("\n  (example|nearest): ")) << "shows a line that works";
}

}  // namespace refused
