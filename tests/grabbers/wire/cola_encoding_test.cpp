// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/wire/cola_encoding.hpp"

#include <gtest/gtest.h>

namespace crisp {
namespace {

using namespace crisp::wire;
using namespace std::string_literals;

TEST(ColaMessage, IsByteForByteWhatARealDriverSentToARealLms111) {
  const Bytes login =
      cola_message("sMN", "SetAccessMode", {std::uint8_t{3}, std::uint32_t{0xF4724744}}, ColaLanguage::B);
  EXPECT_EQ(as_text(login), "\x02\x02\x02\x02\0\0\0\x17sMN SetAccessMode \x03\xf4\x72\x47\x44\xb3"s);
}

TEST(ColaMessage, AnswersAsARealLms111Did) {
  const Bytes accepted = cola_message("sAN", "SetAccessMode", {std::uint8_t{1}}, ColaLanguage::B);
  EXPECT_EQ(as_text(accepted), "\x02\x02\x02\x02\0\0\0\x13sAN SetAccessMode \x01\x38"s);
  EXPECT_EQ(as_text(cola_error(3, ColaLanguage::B)), "\x02\x02\x02\x02\0\0\0\x05sFA\0\x03\x77"s);
}

TEST(ColaMessage, WritesTextInColaA) {
  const Bytes login =
      cola_message("sMN", "SetAccessMode", {std::uint8_t{3}, std::uint32_t{0xF4724744}}, ColaLanguage::A);
  EXPECT_EQ(as_text(login), "\x02sMN SetAccessMode 3 F4724744\x03");
  const Bytes range =
      cola_message("sRA", "LMPoutputRange", {std::uint16_t{1}, std::int32_t{-450000}}, ColaLanguage::A);
  EXPECT_EQ(as_text(range), "\x02sRA LMPoutputRange 1 FFF92230\x03");
  const Bytes name = cola_message("sRA", "LocationName", {"not defined"s}, ColaLanguage::A);
  EXPECT_EQ(as_text(name), "\x02sRA LocationName B not defined\x03");
  EXPECT_EQ(as_text(cola_error(26, ColaLanguage::A)), "\x02sFA 1A\x03");
}

TEST(ColaMessage, ReadsTheFirstByteOfAnAnswer) {
  const auto answer = parse_cola(as_bytes("sAN LMCstartmeas \x05"), ColaLanguage::B);
  EXPECT_EQ(first_byte(*answer), 5U);
  EXPECT_EQ(first_byte(*parse_cola(as_bytes("sAN LMCstartmeas 1"), ColaLanguage::A)), 1U);
  EXPECT_FALSE(first_byte(*parse_cola(as_bytes("sAN LMCstartmeas "), ColaLanguage::B)));
  EXPECT_FALSE(first_byte(*parse_cola(as_bytes("sAN LMCstartmeas x"), ColaLanguage::A)));
}

}  // namespace
}  // namespace crisp
