// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "grabbers/wire/plate_framer.hpp"
#include "grabbers/wire/plate_sentence.hpp"

namespace crisp {
namespace {

using testing::ElementsAre;

std::vector<std::uint16_t> sequences(PlateFramer& framer, std::string_view text,
                                     std::size_t piece = 1 << 20) {
  std::vector<std::uint16_t> found;
  for (std::size_t i = 0; i < text.size(); i += piece) {
    framer.feed(as_bytes(text.substr(i, piece)), 0,
                [&](const PlateReading& r) { found.push_back(r.sequence); });
  }
  framer.gap();
  return found;
}

std::string sentence(std::uint16_t sequence) {
  return encode_plate_sentence({.sequence = sequence, .device_us = 4294967295U, .count = 4294967295U});
}

TEST(PlateSentence, ReadsAndWritesTheExampleOfItsFormat) {
  PlateReading reading{.receipt_ns = 5};
  ASSERT_EQ(decode_plate_sentence("$PPLT,7,1523342,1004211*04", reading), PlateFailure::None);
  EXPECT_EQ(reading.sequence, 7);
  EXPECT_EQ(reading.device_us, 1523342U);
  EXPECT_EQ(reading.count, 1004211U);
  EXPECT_EQ(reading.receipt_ns, 5);
  EXPECT_EQ(encode_plate_sentence(reading), "$PPLT,7,1523342,1004211*04\r\n");
}

TEST(PlateSentence, RefusesFieldsOutOfTheirRange) {
  const auto verdict = [](const std::string& body) {
    unsigned sum = 0;
    for (const char c : body) sum ^= static_cast<unsigned char>(c);
    char checksum[4];
    std::snprintf(checksum, sizeof checksum, "*%02X", sum);
    PlateReading reading;
    return decode_plate_sentence("$" + body + checksum, reading);
  };
  EXPECT_EQ(verdict("PPLT,65535,4294967295,4294967295"), PlateFailure::None);
  EXPECT_EQ(verdict("PPLT,0,0,0"), PlateFailure::None);
  for (const auto* body :
       {"PPLT,65536,0,0", "PPLT,0,4294967296,0", "PPLT,0,0,4294967296", "PPLT,-1,0,0", "PPLT,+1,0,0",
        "PPLT,1,2", "PPLT,1,2,3,4", "PPLT,1,2,3,", "PPLT,1,,3", "PPLT, 1,2,3", "PPLT,1,2,0x3", "PPLT,,,"}) {
    EXPECT_EQ(verdict(body), PlateFailure::BadField) << body;
  }
  EXPECT_EQ(verdict("GPRMC,1,2,3"), PlateFailure::OtherSentence);
}

TEST(PlateSentence, RefusesEveryOtherChecksumAndEveryShorterLine) {
  const std::string good = "$PPLT,7,1523342,1004211*04";
  PlateReading reading;
  for (const auto* checksum : {"*05", "*4", "*0", "*", "", "*004", "*04 ", "*G4"}) {
    EXPECT_NE(decode_plate_sentence(good.substr(0, good.size() - 3) + checksum, reading), PlateFailure::None);
  }
  for (std::size_t n = 0; n < good.size(); ++n) {
    EXPECT_NE(decode_plate_sentence(good.substr(0, n), reading), PlateFailure::None) << n;
  }
}

TEST(PlateSentence, RefusesEverySingleFlippedBit) {
  const std::string good = "$PPLT,7,1523342,1004211*0A";
  PlateReading reading;
  for (std::size_t bit = 0; bit < good.size() * 8; ++bit) {
    auto damaged = good;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << (bit % 8)));
    EXPECT_NE(decode_plate_sentence(damaged, reading), PlateFailure::None) << damaged;
  }
}

TEST(PlateFramer, FindsTheSameHoweverTheStreamIsCut) {
  const auto text =
      "half,1*00\r\n" + sentence(1) + sentence(2) + "noise" + sentence(3) + "\n\n" + sentence(4);
  for (std::size_t piece = 1; piece <= text.size(); ++piece) {
    PlateFramer framer;
    EXPECT_THAT(sequences(framer, text, piece), ElementsAre(1, 2, 3, 4));
    EXPECT_EQ(framer.counts().skipped_bytes, 9U + 5U);
    EXPECT_EQ(framer.counts().readings, 4U);
  }
}

TEST(PlateFramer, CountsWhatIsNoReadingByItsReason) {
  PlateFramer framer;
  auto wrong = sentence(9);
  wrong[8] = wrong[8] == '0' ? '1' : '0';
  const auto text = sentence(1) + "$PPLT,2,3" + sentence(3) + wrong + "$GPRMC,1*56\r\n" + "$PPLT,1,2*1B\r\n" +
                    "$" + std::string(500, 'x') + "\r\n" + sentence(4) + "$PPLT,5,1";
  EXPECT_THAT(sequences(framer, text), ElementsAre(1, 3, 4));
  EXPECT_EQ(framer.counts().of(PlateFailure::Truncated), 3U) << "overtaken, endless, and cut at the end";
  EXPECT_EQ(framer.counts().of(PlateFailure::BadChecksum), 1U);
  EXPECT_EQ(framer.counts().of(PlateFailure::OtherSentence), 1U);
  EXPECT_EQ(framer.counts().of(PlateFailure::BadField), 1U);
}

TEST(PlateFramer, StampsAReadingWithTheLatestOfItsBytes) {
  PlateFramer framer;
  std::vector<std::int64_t> times;
  const auto take = [&](const PlateReading& r) { times.push_back(r.receipt_ns); };
  const auto text = sentence(1);
  framer.feed(as_bytes(text.substr(0, 10)), 70, take);
  EXPECT_TRUE(framer.waiting());
  framer.feed(as_bytes(text.substr(10) + text), 50, take);
  EXPECT_THAT(times, ElementsAre(70, 50));
  EXPECT_FALSE(framer.waiting());
}

}  // namespace
}  // namespace crisp
