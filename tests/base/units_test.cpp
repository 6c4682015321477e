#include "base/units.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "base/text.hpp"

namespace ejecta {
namespace {

using enum Dimension;
using testing::HasSubstr;
using testing::Not;

std::string refusal(const std::string& text, Dimension d) {
  try {
    parse_quantity(text, d);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(Units, DecimalFractionsAreTheNearestDouble) {
  EXPECT_EQ(parse_quantity("1.8 mm", length), 1.8e-3);
  EXPECT_EQ(parse_quantity("8 ms", time), 8e-3);
  EXPECT_EQ(parse_quantity("0.3 um", length), 0.3e-6);
  EXPECT_EQ(parse_quantity("8ms", time), 8e-3) << "the blank may be left out";
  EXPECT_EQ(parse_quantity(" +8  ms ", time), 8e-3);
}

TEST(Units, ConversionsOfEachKind) {
  EXPECT_DOUBLE_EQ(parse_quantity("180 deg", angle), std::numbers::pi);
  EXPECT_DOUBLE_EQ(parse_quantity("60 rpm", angular_velocity), 2 * std::numbers::pi);
  EXPECT_DOUBLE_EQ(parse_quantity("25 C", temperature), 298.15);
  EXPECT_NEAR(parse_quantity("77 F", temperature), 298.15, 1e-9);
  EXPECT_DOUBLE_EQ(parse_quantity("2.7 g/cm3", density), 2700.0);
  EXPECT_DOUBLE_EQ(parse_quantity("1 cP", viscosity), 1e-3);
  EXPECT_DOUBLE_EQ(parse_quantity("1 mPa s", viscosity), 1e-3);
  EXPECT_DOUBLE_EQ(parse_quantity("5 MPa", pressure), 5e6);
  EXPECT_DOUBLE_EQ(parse_quantity("36 km/h", velocity), 10.0);
  EXPECT_DOUBLE_EQ(parse_quantity("100 mm2", area), 1e-4);
  EXPECT_DOUBLE_EQ(parse_quantity("0.287 kJ/kg/K", specific_heat), 287.0);
}

TEST(Units, GaugeAndAbsoluteReferToTheAmbientPressure) {
  EXPECT_EQ(parse_quantity("700 kPa gauge", pressure_absolute, 101325.0), 801325.0);
  EXPECT_EQ(parse_quantity("700 kPa absolute", pressure_absolute, 101325.0), 700000.0);
  EXPECT_EQ(parse_quantity("101325 Pa absolute", pressure_gauge, 101325.0), 0.0);
  EXPECT_EQ(parse_quantity("-2 bar gauge", pressure_gauge, 101325.0), -200000.0);
  EXPECT_THAT(refusal("7 bar", pressure_absolute), HasSubstr("\"7 bar gauge\" or \"7 bar absolute\""));
  EXPECT_THAT(refusal("7 bar gauge", pressure), HasSubstr("neither gauge nor absolute"));
}

TEST(Units, AsInstrumentsAndPeopleWriteThem) {
  for (const char* seven :
       {"7 barg", "7 bar(g)", "7 bar (g)", "7 bar g", "700 kPag", "0.7 MPa(gauge)", "7 bar gauge"})
    EXPECT_DOUBLE_EQ(parse_quantity(seven, pressure_absolute, 101325.0), 801325.0) << seven;
  for (const char* seven : {"7 bara", "7 bar(a)", "7 bar abs", "7 bar absolute"})
    EXPECT_DOUBLE_EQ(parse_quantity(seven, pressure_absolute, 101325.0), 700000.0) << seven;
  EXPECT_NEAR(parse_quantity("100 psig", pressure_absolute, 0.0), 689475.7293168, 1e-6);
  EXPECT_NEAR(parse_quantity("100 psia", pressure_absolute, 101325.0), 689475.7293168, 1e-6);
  EXPECT_EQ(parse_quantity("12 \u00b5m", length), 12e-6);
  EXPECT_EQ(parse_quantity("12 \u03bcm", length), 12e-6);
  EXPECT_EQ(parse_quantity("12 \u00b5s", time), 12e-6);
  EXPECT_EQ(parse_quantity("5 N/mm2", pressure), 5e6);
  EXPECT_EQ(parse_quantity("5 N/mm\u00b2", pressure), 5e6);
  EXPECT_EQ(parse_quantity("2700 kg/m\u00b3", density), 2700.0);
  EXPECT_EQ(parse_quantity("9.81 m/s^2", acceleration), 9.81);
  EXPECT_DOUBLE_EQ(parse_quantity("45 \u00b0", angle), std::numbers::pi / 4);
  EXPECT_DOUBLE_EQ(parse_quantity("45\u00b0", angle), std::numbers::pi / 4);
  EXPECT_DOUBLE_EQ(parse_quantity("20 \u00b0C", temperature), 293.15);
  EXPECT_NEAR(parse_quantity("68 \u00b0F", temperature), 293.15, 1e-9);
  EXPECT_EQ(parse_quantity("18 \u00b5Pa\u00b7s", viscosity), 18e-6);
  EXPECT_EQ(parse_quantity("8\u00a0ms", time), 8e-3) << "with a blank that does not break";
  EXPECT_THAT(refusal("7 barg", pressure), HasSubstr("neither gauge nor absolute"));
  EXPECT_THAT(refusal("7 g", pressure_absolute), HasSubstr("unknown unit"));
  EXPECT_EQ(to_si(1.0, "\u00b5s", time), 1e-6);
}

TEST(Units, ACommaIsNoDecimalPoint) {
  EXPECT_THAT(refusal("5,5 ms", time), HasSubstr("a number has a decimal point (\"5.5 ms\")"));
  EXPECT_THAT(refusal("1,000 mm", length), Not(HasSubstr("1.000"))) << "a thousand, or one";
  EXPECT_EQ(with_decimal_point("0,001"), "0.001");
  EXPECT_EQ(with_decimal_point("1,2,3"), "");
  EXPECT_EQ(with_decimal_point("8 ms"), "");
}

TEST(Units, WhatIsNoQuantityIsRefused) {
  EXPECT_THAT(refusal("8", time), HasSubstr("has no unit"));
  EXPECT_THAT(refusal("ms", time), HasSubstr("does not start with a finite number"));
  EXPECT_THAT(refusal("nan s", time), HasSubstr("finite"));
  EXPECT_THAT(refusal("-inf s", time), HasSubstr("finite"));
  EXPECT_THAT(refusal("1e308 km", length), HasSubstr("too large"));
  EXPECT_THAT(refusal("8 Ms", time), HasSubstr("nearest is \"ms\""));
  EXPECT_THAT(refusal("", time), HasSubstr("finite number"));
}

/// Whatever is written is read back to the same bits, for every dimension and across many magnitudes.
TEST(Units, FormatAndParseAreInverse) {
  for (int d = static_cast<int>(length); d <= static_cast<int>(specific_heat); ++d) {
    const auto dimension = static_cast<Dimension>(d);
    for (double v = 1.23456789e-12; v < 1e13; v *= 7.3)
      for (double x : {v, -v, std::nextafter(v, 0.0), 0.0})
        EXPECT_EQ(parse_quantity(format_quantity(x, dimension), dimension), x)
            << format_quantity(x, dimension);
  }
}

TEST(Units, FormatChoosesTheHandyUnit) {
  EXPECT_EQ(format_quantity(0.008, time), "8 ms");
  EXPECT_EQ(format_quantity(0.0018, length), "1.8 mm");
  EXPECT_EQ(format_quantity(5e6, pressure), "5 MPa");
  EXPECT_EQ(format_quantity(801325.0, pressure_absolute), "801325 Pa absolute");
}

TEST(Units, EveryDimensionHasAnSiUnitAndAWorkingExample) {
  for (int d = static_cast<int>(length); d <= static_cast<int>(specific_heat); ++d) {
    const auto dimension = static_cast<Dimension>(d);
    EXPECT_FALSE(si_unit(dimension).empty());
    EXPECT_TRUE(std::isfinite(parse_quantity(example(dimension), dimension))) << example(dimension);
    for (const std::string& unit : known_units(dimension))
      EXPECT_TRUE(std::isfinite(parse_quantity("1 " + unit, dimension))) << unit;
  }
}

TEST(Text, NearestWord) {
  const std::vector<std::string> words{"grid", "courant", "k-omega-sst", "ms"};
  EXPECT_EQ(nearest("gird", words), "grid");
  EXPECT_EQ(nearest("couran", words), "courant");
  EXPECT_EQ(nearest("k-omega", words), "k-omega-sst");
  EXPECT_EQ(nearest("msec", words), "ms");
  EXPECT_EQ(nearest("turbulence", words), "");
}

TEST(Text, NumbersFillTheWholeText) {
  EXPECT_EQ(parse_number("1.5e-3"), 1.5e-3);
  EXPECT_EQ(parse_number("1.5 m"), std::nullopt);
  EXPECT_EQ(parse_number("nan"), std::nullopt);
  EXPECT_EQ(parse_number(""), std::nullopt);
}

}  // namespace
}  // namespace ejecta
