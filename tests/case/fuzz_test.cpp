#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "../../fuzz/case_property.hpp"

namespace fs = std::filesystem;

/// A short run, the same every time, of what the fuzzer does for longer: mutated cases are read or refused,
/// never worse.
namespace {

std::vector<std::string> corpus() {
  std::vector<fs::path> paths;
  for (const char* folder : {"/fuzz/case_corpus", "/tests/bad_cases", "/tests/good_cases"})
    for (const auto& entry : fs::directory_iterator(std::string(EJECTA_SOURCE_DIR) + folder))
      if (entry.is_regular_file()) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> texts;
  for (const fs::path& path : paths) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    texts.push_back(text.str());
  }
  return texts;
}

class Mutator {
 public:
  explicit Mutator(std::vector<std::string> texts) : texts_(std::move(texts)) {}

  std::string next() {
    std::string text = pick(texts_);
    for (int n = below(4); n >= 0; --n) mutate(text);
    return text;
  }

 private:
  std::size_t below(std::size_t n) { return n == 0 ? 0 : random_() % n; }
  const std::string& pick(const std::vector<std::string>& list) { return list[below(list.size())]; }

  void mutate(std::string& text) {
    static const std::vector<std::string> tokens{"[",          "]",
                                                 "[[",         "\"",
                                                 "=",          "nan",
                                                 "-inf",       "1e999",
                                                 "\"= x^\"",   "''",
                                                 "{",          "\n",
                                                 "\\u0",       "0x",
                                                 "1979-05-27", "true",
                                                 ".",          ",",
                                                 "-1",         "\xff",
                                                 "\"\"\"",     "99999999999999999999",
                                                 "\" gauge\"", "body.0",
                                                 "#"};
    const std::size_t at = below(text.size() + 1);
    switch (below(5)) {
      case 0:
        text.insert(at, pick(tokens));
        break;
      case 1:
        text.erase(at, below(20));
        break;
      case 2:
        if (at < text.size()) text[at] = static_cast<char>(below(256));
        break;
      case 3: {
        const std::string& other = pick(texts_);
        const std::size_t from = below(other.size());
        text.insert(at, other.substr(from, below(200)));
        break;
      }
      case 4:
        text.resize(at);
        break;
    }
  }

  std::vector<std::string> texts_;
  std::mt19937 random_{20240501};
};

TEST(FuzzCase, MutatedCasesAreReadOrRefused) {
  Mutator mutator(corpus());
  for (int n = 0; n < 2000; ++n) {
    const std::string text = mutator.next();
    ASSERT_NO_THROW(ASSERT_TRUE(ejecta::case_survives(text)) << text) << text;
  }
}

}  // namespace
