// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/wire/cola.hpp"

#include <gmock/gmock.h>

#include <crisp/error.hpp>

#include "tests/grabbers/wire/samples.hpp"

namespace crisp {
namespace {

using namespace crisp::wire;

ByteView payload_b(ByteView frame) { return frame.subspan(8, frame.size() - 9); }

TEST(Cola, ReadsTheLoginOfARealCapture) {
  const auto frame = from_hex(
      "02 02 02 02 00 00 00 17 73 4d 4e 20 53 65 74 41 63 63 65 73 73 4d 6f 64 65 20 03 f4 72 47 44 b3");
  EXPECT_EQ(cola_checksum(payload_b(frame)), 0xb3);
  const auto telegram = parse_cola(payload_b(frame), ColaLanguage::B);
  ASSERT_TRUE(telegram);
  EXPECT_EQ(telegram->command, "sMN");
  EXPECT_EQ(telegram->name, "SetAccessMode");
  EXPECT_THAT(telegram->parameters, testing::ElementsAre(0x03, 0xf4, 0x72, 0x47, 0x44));
  EXPECT_EQ(cola_frame(payload_b(frame), ColaLanguage::B), frame);
}

TEST(Cola, FramesTheReplyWithTheChecksumOfARealDevice) {
  const auto frame =
      from_hex("02 02 02 02 00 00 00 13 73 41 4e 20 53 65 74 41 63 63 65 73 73 4d 6f 64 65 20 01 38");
  EXPECT_EQ(cola_frame(payload_b(frame), ColaLanguage::B), frame);
}

TEST(Cola, ReadsTheErrorOfARealDevice) {
  const auto frame = from_hex("02 02 02 02 00 00 00 05 73 46 41 00 03 77");
  const auto telegram = parse_cola(payload_b(frame), ColaLanguage::B);
  ASSERT_TRUE(telegram);
  EXPECT_EQ(cola_error_code(*telegram), 3U);
  EXPECT_EQ(cola_error_text(3), "unknown variable");
  EXPECT_EQ(cola_frame(payload_b(frame), ColaLanguage::B), frame);
}

TEST(Cola, ReadsErrorsInAscii) {
  const auto telegram = parse_cola(as_bytes("sFA 19"), ColaLanguage::A);
  ASSERT_TRUE(telegram);
  EXPECT_EQ(cola_error_code(*telegram), 0x19U);
  EXPECT_THAT(std::string(cola_error_text(0x19)), testing::HasSubstr("asynchronous"));
}

TEST(Cola, KnowsWordsForEveryCodeEvenUnknownOnes) {
  for (unsigned code = 0; code <= 0x20; ++code) EXPECT_FALSE(cola_error_text(code).empty());
  EXPECT_THAT(std::string(cola_error_text(0x20)), testing::HasSubstr("arrays"));
  EXPECT_THAT(std::string(cola_error_text(4711)), testing::HasSubstr("not list"));
}

TEST(Cola, TakesTheWholeNameAndNotItsBegin) {
  EXPECT_EQ(parse_cola(as_bytes("sSN LMDscandatamon 1"), ColaLanguage::A)->name, "LMDscandatamon");
  EXPECT_EQ(parse_cola(as_bytes("sWA LMDscandatacfg "), ColaLanguage::B)->name, "LMDscandatacfg");
  EXPECT_EQ(parse_cola(as_bytes("sRN LMPoutputRange"), ColaLanguage::B)->name, "LMPoutputRange");
}

TEST(Cola, RefusesPayloadsThatBeginLikeNoTelegram) {
  for (const auto* text : {"", "s", "sRN", "hello world", "sRNLMDscandata", "SRN LMDscandata"}) {
    EXPECT_FALSE(parse_cola(as_bytes(text), ColaLanguage::A)) << text;
  }
}

TEST(Cola, RefusesToFrameAnImplausiblePayload) {
  EXPECT_THROW(cola_frame({}, ColaLanguage::B), Error);
  EXPECT_THROW(cola_frame(Bytes(kLargestColaPayload + 1, 's'), ColaLanguage::A), Error);
}

}  // namespace
}  // namespace crisp
