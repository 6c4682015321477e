#include "case/edit_text.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "case/load.hpp"
#include "case/template.hpp"

namespace ejecta {
namespace {

const std::string kWritten = R"(# mine
[run]
end_time = "8 ms"   # long enough
[grid.x]
points = [
  "-1 mm", # here
  "1 mm",
]
cells = [4]

[[body]]
name = "a"
# density = "2700 kg/m3"
[[body]]
name = "b"
size = ["1 mm", "1 mm", "1 mm"])";

TEST(EditText, ChangesAValueAndNothingElse) {
  std::string expected = kWritten;
  expected.replace(expected.find("\"8 ms\""), 6, "\"9 ms\"");
  EXPECT_EQ(with_key(kWritten, "run.end_time", "\"9 ms\""), expected);
}

TEST(EditText, ReplacesAListOfSeveralLines) {
  const std::string text = with_key(kWritten, "grid.x.points", R"(["-2 mm", "2 mm"])");
  EXPECT_NE(text.find("points = [\"-2 mm\", \"2 mm\"]\ncells"), std::string::npos) << text;
}

TEST(EditText, PutsANewKeyAtTheEndOfItsSection) {
  EXPECT_NE(with_key(kWritten, "run.courant", "0.5").find("# long enough\ncourant = 0.5\n[grid.x]"),
            std::string::npos);
  EXPECT_NE(with_key(kWritten, "grid.x.grading", "[1]").find("cells = [4]\ngrading = [1]\n\n[[body]]"),
            std::string::npos);
  EXPECT_TRUE(with_key(kWritten, "body.b.mass", "\"1 g\"").ends_with("\"1 mm\"]\nmass = \"1 g\"\n"));
}

TEST(EditText, PutsAKeyWhereItStandsAsAComment) {
  EXPECT_NE(
      with_key(kWritten, "body.0.density", "\"3 t/m3\"").find("name = \"a\"\ndensity = \"3 t/m3\"\n[[body]]"),
      std::string::npos);
  EXPECT_TRUE(with_key(kWritten, "body.1.density", "\"3 t/m3\"").ends_with("]\ndensity = \"3 t/m3\"\n"))
      << "the comment belongs to the other body";
}

TEST(EditText, MakesASectionThatIsNotThere) {
  EXPECT_TRUE(with_key(kWritten, "grid.refinement", "2").ends_with("\n\n[grid]\nrefinement = 2\n"));
  EXPECT_TRUE(
      with_key(kWritten, "valve.duration", "\"8 ms\"").ends_with("\n\n[valve]\nduration = \"8 ms\"\n"));
  EXPECT_TRUE(with_key(kWritten, "body.2.name", "\"c\"").ends_with("\n\n[[body]]\nname = \"c\"\n"));
  EXPECT_EQ(with_key("", "run.title", "\"x\""), "[run]\ntitle = \"x\"\n");
}

TEST(EditText, TakesAKeyOut) {
  const std::string text = without_key(kWritten, "run.end_time");
  EXPECT_NE(text.find("[run]\n[grid.x]"), std::string::npos);
  EXPECT_EQ(without_key(kWritten, "run.courant"), kWritten);
}

TEST(EditText, RefusesWhatIsNoKey) {
  EXPECT_THROW(with_key("[run\n", "run.title", "1"), InputError);
  EXPECT_THROW(with_key(kWritten, "run", "1"), InputError);
  EXPECT_THROW(with_key(kWritten, "end_time", "1"), InputError);
  EXPECT_THROW(with_key("a = { b = 1 }\n", "a.c", "1"), InputError);
}

TEST(EditText, AListGrowsByItsNextElementOnly) {
  for (const char* path : {"body.3.name", "body.4294967296.name", "body.99999999999999999999.name",
                           "body.-1.name", "wall.1.name"})
    EXPECT_THROW(with_key(kWritten, path, "\"c\""), InputError) << path;
}

TEST(EditText, TheCaseReadsWhatWasSet) {
  for (const Word& kind : template_kinds()) {
    const std::string text = case_template(kind.name);
    const std::string changed =
        with_key(with_key(text, "run.end_time", "\"0.25 s\""), "environment.temperature", "\"300 K\"");
    const Case c = parse_case(changed, "case.toml");
    EXPECT_EQ(c.run.end_time, 0.25) << kind.name;
    EXPECT_EQ(c.environment.temperature, 300.0);
  }
}

}  // namespace
}  // namespace ejecta
