// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/files/quantity.hpp"

#include <gmock/gmock.h>

#include <limits>

namespace crisp {
namespace {

using namespace crisp::files;
using testing::HasSubstr;

double value(std::string_view text, std::string_view unit) {
  const auto result = parse_quantity(text, unit);
  const auto* number = std::get_if<double>(&result);
  EXPECT_NE(number, nullptr) << text << ": " << std::get<Complaint>(result).text;
  return number ? *number : std::numeric_limits<double>::quiet_NaN();
}

std::string refusal(std::string_view text, std::string_view unit) {
  const auto result = parse_quantity(text, unit);
  const auto* complaint = std::get_if<Complaint>(&result);
  return complaint ? complaint->text : "not refused";
}

TEST(Quantity, ConvertsUnitsToSi) {
  EXPECT_DOUBLE_EQ(value("5cm", "m"), 0.05);
  EXPECT_DOUBLE_EQ(value("50 cm", "m"), 0.5);
  EXPECT_DOUBLE_EQ(value("-1.5e3mm", "m"), -1.5);
  EXPECT_DOUBLE_EQ(value("180deg", "rad"), 3.14159265358979323846);
  EXPECT_DOUBLE_EQ(value("90°", "rad"), 1.57079632679489661923);
  EXPECT_DOUBLE_EQ(value("20ms", "s"), 0.02);
  EXPECT_DOUBLE_EQ(value("7\u00b5s", "s"), 7e-6);
  EXPECT_DOUBLE_EQ(value("7\u03bcs", "s"), 7e-6) << "the Greek letter in place of the sign";
  EXPECT_DOUBLE_EQ(value("2kHz", "Hz"), 2000);
  EXPECT_DOUBLE_EQ(value("60rpm", "rad/s"), 6.28318530717958647692);
  EXPECT_DOUBLE_EQ(value("250ppm", "1"), 2.5e-4);
  EXPECT_DOUBLE_EQ(value("3 kg", "kg"), 3);
}

TEST(Quantity, IsTheSameNumberInWhicheverUnitItIsWritten) {
  EXPECT_EQ(value("100us", "s"), 1e-4);
  EXPECT_EQ(value("0.1ms", "s"), 1e-4);
  EXPECT_EQ(value("7um", "m"), 7e-6);
  EXPECT_EQ(value("3ns", "s"), 3e-9);
  EXPECT_EQ(value("7ppm", "1"), 7e-6);
  EXPECT_EQ(value("29mm", "m"), 0.029);
}

TEST(Quantity, TakesAPlainNumberAsSi) {
  EXPECT_EQ(value("0.05", "m"), 0.05);
  EXPECT_EQ(value("+.5", "s"), 0.5);
  EXPECT_EQ(value("1e-3", ""), 1e-3);
  EXPECT_EQ(value("0", "rad"), 0);
}

TEST(Quantity, ReadsFractions) {
  EXPECT_EQ(value("1/2 m", "m"), 0.5);
  EXPECT_EQ(value("1/6deg", "rad"), value("1deg", "rad") / 6);
  EXPECT_EQ(value("-3/4", ""), -0.75);
  EXPECT_EQ(value("1/1e3", ""), 1e-3);
  EXPECT_EQ(value("30rad/s", "rad/s"), 30);
  EXPECT_THAT(refusal("1/0", ""), HasSubstr("is not a number"));
  EXPECT_THAT(refusal("1/2/3", ""), HasSubstr("has a unit"));
  EXPECT_THAT(refusal("1/", ""), HasSubstr("has a unit"));
}

TEST(Quantity, RefusesUnitsInsteadOfStrippingThem) {
  EXPECT_EQ(refusal("5cm", "s"), "'5cm' cannot be converted to s");
  EXPECT_EQ(refusal("5cm", ""), "'5cm' has a unit, but a plain number is expected");
  EXPECT_THAT(refusal("5furlong", "m"), HasSubstr("unknown unit 'furlong'; understood are m, um"));
  EXPECT_EQ(refusal("5m", "1"), "'5m' cannot be converted to a number without dimension");
  EXPECT_THAT(refusal("5 m m", "m"), HasSubstr("unknown unit"));
}

TEST(Quantity, RefusesWhatIsNoPlainDecimalNumber) {
  for (const auto* text :
       {"", " ", "m", "/2", "inf", "-inf", "nan", "--5", "+-5", "1e999", "five", "-", "."}) {
    EXPECT_THAT(refusal(text, "m"), HasSubstr("is not a number")) << text;
  }
  EXPECT_THAT(refusal("010", ""), HasSubstr("begins with 0"));
  EXPECT_THAT(refusal("-007.5", ""), HasSubstr("begins with 0"));
  EXPECT_THAT(refusal("0x10", ""), HasSubstr("has a unit"));
  EXPECT_THAT(refusal("1_000", ""), HasSubstr("has a unit"));
  EXPECT_THAT(refusal("1e308km", "m"), HasSubstr("not a finite number"));
}

TEST(Integer, ReadsWholeNumbersExactly) {
  EXPECT_EQ(std::get<std::int64_t>(parse_integer("9223372036854775807")), 9223372036854775807);
  EXPECT_EQ(std::get<std::int64_t>(parse_integer("-9223372036854775808")),
            std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(std::get<std::int64_t>(parse_integer("1e6")), 1000000);
  EXPECT_EQ(std::get<std::int64_t>(parse_integer("+5")), 5);
}

TEST(Integer, RefusesTheRest) {
  for (const auto* text : {"1.5", "9223372036854775808", "1e300", "0777", "5m", "", "true", "1e17"}) {
    EXPECT_TRUE(std::holds_alternative<Complaint>(parse_integer(text))) << text;
  }
}

}  // namespace
}  // namespace crisp
