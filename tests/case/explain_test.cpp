#include "case/explain.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "base/error.hpp"
#include "case/documented.hpp"
#include "case/load.hpp"
#include "case/template.hpp"
#include "case/write.hpp"

using namespace ejecta;
using testing::HasSubstr;
using testing::Not;

namespace {

std::string file_text(const std::string& name) {
  std::ifstream file(std::string(EJECTA_SOURCE_DIR) + name);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(Explain, OneKey) {
  const std::string text = explain("valve.rise_time");
  EXPECT_THAT(text, HasSubstr("From closed to fully open"));
  EXPECT_THAT(text, HasSubstr("default   \"6 ms\""));
  EXPECT_THAT(text, HasSubstr("Fig. 9"));
}

TEST(Explain, ListElementsAndFacesMeanTheirSection) {
  EXPECT_EQ(explain("body.0.size"), explain("body.size"));
  EXPECT_EQ(explain("boundary.z_max.type"), explain("boundary.x_min.type"));
  EXPECT_THAT(explain("[[body]]"), HasSubstr("sphere_diameter"));
}

TEST(Explain, WordsOfAChoice) { EXPECT_THAT(explain("flow.turbulence"), HasSubstr("\"k-omega-sst\"")); }

TEST(Explain, SearchFindsHelpAndWords) {
  EXPECT_THAT(explain("Courant"), HasSubstr("run.courant"));
  EXPECT_THAT(explain("hertz"), HasSubstr("contact.law"));
}

TEST(Explain, NothingFoundNamesTheNearestKey) {
  try {
    explain("valve.rise_tiem");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("nearest is \"valve.rise_time\""));
  }
}

TEST(Schema, EveryKeyHasHelpAndAnExampleThatIsRead) {
  Case c = documented_case();
  for (const Section& s : documented_sections(c))
    for (const Key& key : s.keys(0)) {
      EXPECT_FALSE(key.help.empty()) << s.name << "." << key.name;
      EXPECT_THAT(explain(s.name + "." + key.name), HasSubstr(key.help));
      EXPECT_FALSE(example(key).empty()) << s.name << "." << key.name;
    }
}

TEST(Schema, ReferencePageIsUpToDate) {
  EXPECT_TRUE(file_text("/docs/reference.md") == reference_page())
      << "run: ejecta explain --markdown > docs/reference.md";
}

TEST(Schema, JsonSchemaIsUpToDate) {
  EXPECT_TRUE(file_text("/docs/ejecta.schema.json") == json_schema())
      << "run: ejecta explain --json-schema > docs/ejecta.schema.json";
  const auto json = nlohmann::json::parse(json_schema());
  EXPECT_EQ(json["properties"]["body"]["items"]["properties"]["shape"]["enum"][0], "sphere");
  EXPECT_EQ(json["properties"]["boundary"]["properties"]["z_min"]["properties"]["patch"]["type"], "array");
  EXPECT_EQ(json["properties"]["run"]["required"][0], "end_time");
  const std::regex time(json["properties"]["run"]["properties"]["end_time"]["pattern"].get<std::string>());
  for (const char* good : {"8 ms", "1.5e-3 s", "2 min"}) EXPECT_TRUE(std::regex_match(good, time)) << good;
  for (const char* bad : {"8", "ms", "8 mm"}) EXPECT_FALSE(std::regex_match(bad, time)) << bad;
}

class Template : public testing::TestWithParam<std::string> {};

TEST_P(Template, IsACaseThatLoadsAndRoundTrips) {
  const std::string text = case_template(GetParam());
  const Case c = parse_case(text, GetParam());
  const std::string resolved = write_case(c);
  EXPECT_EQ(write_case(parse_case(resolved, "resolved")), resolved);
}

/// Taking a commented key in must be safe: the default or example behind it is a value the reader takes.
TEST_P(Template, CommentedKeysHoldReadableValues) {
  std::istringstream lines(case_template(GetParam()));
  std::string section;
  std::map<std::string, int> elements;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("[[")) {
      section = line.substr(2, line.find(']') - 2);
      const int number = elements[section]++;
      section.append(".").append(std::to_string(number));
    } else if (line.starts_with("[")) {
      section = line.substr(1, line.find(']') - 1);
    }
    const auto equals = line.find(" = ");
    if (!line.starts_with("# ") || equals == std::string::npos || line.find(' ', 2) != equals) continue;
    const std::string value = line.substr(equals + 3, line.find("  # ", equals) - equals - 3);
    try {
      parse_case(case_template(GetParam()), "template",
                 {section + "." + line.substr(2, equals - 2) + "=" + value});
    } catch (const InputError& e) {
      // What the value means may not fit this case; how it is written must.
      EXPECT_THAT(e.what(), Not(HasSubstr("does not fit here"))) << line;
      EXPECT_THAT(e.what(), Not(HasSubstr("cannot be read"))) << line;
      EXPECT_THAT(e.what(), Not(HasSubstr("unit"))) << line;
      EXPECT_THAT(e.what(), Not(HasSubstr("out of range"))) << line;
    }
  }
}

std::vector<std::string> kinds() {
  std::vector<std::string> names;
  for (const Word& w : template_kinds()) names.push_back(w.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Kinds, Template, testing::ValuesIn(kinds()), [](const auto& info) {
  std::string name = info.param;
  std::erase(name, '-');
  return name;
});

}  // namespace
