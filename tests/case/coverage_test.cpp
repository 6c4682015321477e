#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "case/documented.hpp"
#include "case/load.hpp"
#include "case/node.hpp"
#include "case/toml.hpp"
#include "case/write.hpp"

using namespace ejecta;
namespace fs = std::filesystem;

/// Every key of the schema stands in a case that loads: a shipped one or one of tests/good_cases.
namespace {

std::string face_or(const std::string& part) {
  return part.size() == 5 && (part.ends_with("_min") || part.ends_with("_max")) ? "x_min" : part;
}

void collect(const Node& node, const std::string& path, std::set<std::string>& keys) {
  if (!path.empty()) keys.insert(path);
  for (const Node& child : node.children) {
    const std::string below = node.is_list() ? path
                              : path.empty() ? child.key
                                             : path + "." + face_or(child.key);
    collect(child, below, keys);
  }
}

std::vector<fs::path> shipped_cases() {
  std::vector<fs::path> list;
  for (const char* folder : {"cases", "verification", "validation", "tests/good_cases"})
    if (const fs::path root = fs::path(EJECTA_SOURCE_DIR) / folder; fs::is_directory(root))
      for (const auto& entry : fs::recursive_directory_iterator(root))
        if (entry.path().extension() == ".toml") list.push_back(entry.path());
  return list;
}

TEST(ShippedCases, AllLoad) {
  for (const fs::path& path : shipped_cases())
    if (path.parent_path().filename() != "setup")  // what cases extend need not be whole
      EXPECT_NO_THROW(load_case(path.string())) << path;
}

/// As a run writes it, with its files by their whole paths.
TEST(ShippedCases, LoadAsResolvedFromAnotherFolder) {
  for (const fs::path& path : shipped_cases()) {
    if (path.parent_path().filename() == "setup") continue;
    const Case c = load_case(path.string());
    if (c.campaign.enabled) continue;  // a campaign is no run
    const std::string resolved = write_case(with_absolute_files(c));
    EXPECT_NO_THROW(parse_case(resolved, "/another/folder/case.toml")) << path;
  }
}

TEST(ShippedCases, ExerciseEveryKey) {
  std::set<std::string> used;
  for (const fs::path& path : shipped_cases()) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    std::vector<Problem> problems;
    collect(parse_toml(std::make_shared<Source>(Source{path.string(), text.str()}), problems), "", used);
  }
  Case c = documented_case();
  for (const Section& s : documented_sections(c))
    for (const Key& key : s.keys(0))
      EXPECT_TRUE(used.contains(s.name + "." + key.name)) << s.name << "." << key.name;
}

}  // namespace
