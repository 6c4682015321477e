#include <gtest/gtest.h>

#include "case/load.hpp"
#include "refused_cases.hpp"

/// Every file of tests/bad_cases is refused with the words of its "# expect:" lines, the file and a line.
namespace {

class BadCase : public testing::TestWithParam<std::string> {};

TEST_P(BadCase, IsRefusedWithItsMessage) {
  refused::expect_refusal(GetParam(), [](const std::string& path) { ejecta::load_case(path); });
}

INSTANTIATE_TEST_SUITE_P(AllFiles, BadCase, testing::ValuesIn(refused::files("bad_cases")), refused::name_of);

TEST(BadCases, ThereAreEnough) { EXPECT_GE(refused::files("bad_cases").size(), 60u); }

}  // namespace
