// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/wire/text_fields.hpp"

#include <gtest/gtest.h>

namespace crisp {
namespace {

using namespace crisp::wire;

template <class T>
T read(std::string_view text, FieldFailure expected = FieldFailure::None) {
  TextReader reader(text);
  T value{};
  reader.number(value);
  EXPECT_EQ(reader.failure(), expected) << text;
  return value;
}

TEST(TextFields, ReadsHexadecimalAndSignedDecimalNumbers) {
  EXPECT_EQ(read<std::uint16_t>("1388"), 5000);
  EXPECT_EQ(read<std::uint16_t>("+5000"), 5000);
  EXPECT_EQ(read<std::int32_t>("FFF92230"), -450000);
  EXPECT_EQ(read<std::int32_t>("-450000"), -450000);
  EXPECT_EQ(read<std::int16_t>("FFFF"), -1);
  EXPECT_EQ(read<std::uint8_t>("000000000FF"), 255);
}

TEST(TextFields, RefusesWhatIsNoNumberOrDoesNotFit) {
  read<std::uint16_t>("", FieldFailure::TooShort);
  read<std::uint16_t>("G", FieldFailure::NotANumber);
  read<std::uint16_t>("1 ", FieldFailure::None);
  read<std::uint16_t>("+", FieldFailure::NotANumber);
  read<std::uint16_t>("+-5", FieldFailure::NotANumber);
  read<std::uint16_t>("12-", FieldFailure::NotANumber);
  read<std::uint8_t>("100", FieldFailure::OutOfRange);
  read<std::uint16_t>("-1", FieldFailure::OutOfRange);
  read<std::uint32_t>("100000000", FieldFailure::OutOfRange);
  read<std::int32_t>("+99999999999999999999", FieldFailure::OutOfRange);
}

TEST(TextFields, ReadsTextsThatHoldSpacesAndEmptyOnes) {
  for (const auto* text : {"not defined 7", "not defined 7 "}) {
    TextReader reader(text);
    std::string value;
    std::uint8_t number = 0;
    reader.text(value, 11);
    reader.number(number);
    EXPECT_TRUE(reader.ok());
    EXPECT_EQ(value, "not defined");
    EXPECT_EQ(number, 7);
  }
  for (const auto* text : {"0 7", "0  7"}) {  // a length of 0, then one separator or two
    TextReader reader(text);
    std::uint8_t length = 1, number = 0;
    std::string value = "before";
    reader.number(length);
    reader.text(value, length);
    reader.number(number);
    EXPECT_TRUE(reader.ok());
    EXPECT_EQ(value, "");
    EXPECT_EQ(number, 7);
  }
}

TEST(TextFields, RefusesATextWhoseLengthDoesNotLeadToASeparator) {
  TextReader reader("Derecha 0");
  std::string value;
  reader.text(value, 6);
  EXPECT_EQ(reader.failure(), FieldFailure::BadText);
}

}  // namespace
}  // namespace crisp
