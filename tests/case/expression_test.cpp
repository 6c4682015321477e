#include "case/expression.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.hpp"

using namespace ejecta;
using testing::HasSubstr;

namespace {

double value(const std::string& text, double x = 0, double y = 0, double z = 0, double t = 0) {
  return Expression(text)(x, y, z, t);
}

TEST(Expression, Precedence) {
  EXPECT_EQ(value("1 + 2 * 3"), 7.0);
  EXPECT_EQ(value("(1 + 2) * 3"), 9.0);
  EXPECT_EQ(value("8 / 4 / 2"), 1.0);
  EXPECT_EQ(value("8 - 4 - 2"), 2.0);
  EXPECT_EQ(value("2 ^ 3 ^ 2"), 512.0) << "powers bind to the right";
  EXPECT_EQ(value("-2 ^ 2"), -4.0);
  EXPECT_EQ(value("2 ^ -1"), 0.5);
  EXPECT_EQ(value("1 < 2 && 3 < 2 ? 5 : 7"), 7.0);
  EXPECT_EQ(value("1 < 2 || 3 < 2 ? 5 : 7"), 5.0);
  EXPECT_EQ(value("1 || 1 && 0"), 1.0) << "&& binds tighter";
  EXPECT_EQ(value("1 <= 1") + value("2 >= 3") + value("2 > 1"), 2.0);
}

TEST(Expression, VariablesAndFunctions) {
  EXPECT_EQ(value("x + 10 * y + 100 * z + 1000 * t", 1, 2, 3, 4), 4321.0);
  EXPECT_EQ(value("-cos(x) * sin(y) * exp(-2 * t)", 0.3, 0.7, 0, 0.1),
            -std::cos(0.3) * std::sin(0.7) * std::exp(-0.2));
  EXPECT_EQ(value("atan2(1, -1)"), 0.75 * std::numbers::pi);
  EXPECT_EQ(value("min(x, 2) + max(x, 2)", 5), 7.0);
  EXPECT_EQ(value("step(t - 1e-3)", 0, 0, 0, 1e-3), 1.0);
  EXPECT_EQ(value("step(t - 1e-3)", 0, 0, 0, 0.9e-3), 0.0);
  EXPECT_DOUBLE_EQ(value("tan(1) + asin(.5) + acos(0.5) + atan(1) + sinh(1) + cosh(1) + tanh(1)"),
                   std::tan(1.) + std::asin(.5) + std::acos(.5) + std::atan(1.) + std::sinh(1.) +
                       std::cosh(1.) + std::tanh(1.));
  EXPECT_DOUBLE_EQ(value("log(2) + ln(2) + log10(3) + sqrt(2) + abs(-3) + floor(2.7) + pow(2, 3) + e"),
                   2 * std::log(2.) + std::log10(3.) + std::sqrt(2.) + 13.0 + std::numbers::e);
}

TEST(Expression, NanIsNotHidden) {
  EXPECT_TRUE(std::isnan(value("max(1, sqrt(-1))")));
  EXPECT_TRUE(std::isnan(value("min(sqrt(-1), 1)")));
}

TEST(Expression, KnowsWhatItDependsOn) {
  EXPECT_TRUE(Expression("2 * pi").is_constant());
  EXPECT_FALSE(Expression("x").is_constant());
  EXPECT_FALSE(Expression("x").uses_time());
  EXPECT_TRUE(Expression("sin(t)").uses_time());
  EXPECT_EQ(Expression()(1, 2, 3, 4), 0.0);
}

TEST(Expression, ErrorsSayWhere) {
  const std::pair<const char*, const char*> wrong[] = {{"", "column 1"},
                                                       {"1 +", "column 4"},
                                                       {"2 * (1 + x", "\")\" expected"},
                                                       {"sine(x)", "sine"},
                                                       {"1 2", "column 3"},
                                                       {"sin x", "\"(\" expected"},
                                                       {"atan2(1)", "\",\" expected"},
                                                       {"#", "unexpected \"#\""},
                                                       {"1 ? 2", "\":\" expected"}};
  for (const auto& [text, words] : wrong) {
    try {
      Expression e(text);
      ADD_FAILURE() << text << " was accepted";
    } catch (const InputError& e) {
      EXPECT_THAT(e.what(), HasSubstr(words)) << text;
    }
  }
}

TEST(Expression, DeepNestingIsRefusedNotCrashed) {
  EXPECT_THROW(Expression(std::string(100000, '(')), InputError);
  EXPECT_THROW(Expression(std::string(100000, '-') + "1"), InputError);
  std::string deep = "1";
  for (int i = 0; i < 60; ++i) deep = "1+(" + deep + ")";
  EXPECT_THROW(Expression{deep}, InputError) << "stack of the evaluation";
}

}  // namespace
