// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "grabbers/wire/plate_framer.hpp"
#include "grabbers/wire/plate_sentence.hpp"

namespace crisp {
namespace {

using namespace crisp::wire;
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

PlateReading read_line(std::string_view line, const EncoderLine& format,
                       PlateFailure expected = PlateFailure::None) {
  PlateReading reading;
  EXPECT_EQ(decode_encoder_line(line, format, reading), expected) << line;
  return reading;
}

TEST(EncoderLine, ReadsColumnsByTheirSeparators) {
  const EncoderLine commas{.count_column = 2, .time_column = 1, .time_unit = 1e-3};
  for (const auto* line : {"1500,42", "1500, 42", " 1500 ;\t42 ", "1500\t42", "+1500.0,+42,more"}) {
    const auto reading = read_line(line, commas);
    EXPECT_EQ(reading.count, 42U) << line;
    EXPECT_EQ(reading.device_us, 1'500'000U) << line;
  }
  EXPECT_EQ(read_line("E:17:-1", {.begin = "E", .separators = ":", .count_column = 2}).count, 4294967295U);
  EXPECT_EQ(read_line("$ENC,8589934597", {.begin = "$ENC"}).count, 5U) << "modulo 2^32";
  EXPECT_EQ(read_line("5;;7", {.separators = ";", .count_column = 3}).count, 7U) << "the second is empty";
}

TEST(EncoderLine, ReadsTimesModulo2To32Microseconds) {
  const auto time = [](std::string_view text, double unit) {
    return read_line(std::string(text) + ",1", {.count_column = 2, .time_column = 1, .time_unit = unit})
        .device_us;
  };
  EXPECT_EQ(time("4294967297", 1e-6), 1U);
  EXPECT_EQ(time("4294968", 1e-3), 704U) << "4294968000 - 2^32";
  EXPECT_EQ(time("2.000001", 1), 2'000'001U);
}

TEST(EncoderLine, ChecksItsChecksum) {
  // 0x04 is the exclusive or of PPLT,7,1523342,1004211, as of the built-in sentence; F4 the check value of
  // CRC-8/SMBUS for 123456789 in the catalogue of CRC algorithms.
  const EncoderLine exclusive{.begin = "$PPLT", .count_column = 3, .checksum = LineChecksum::exclusive_or};
  EXPECT_EQ(read_line("$PPLT,7,1523342,1004211*04", exclusive).count, 1004211U);
  read_line("$PPLT,7,1523342,1004211*05", exclusive, PlateFailure::BadChecksum);
  read_line("$PPLT,7,1523342,1004211", exclusive, PlateFailure::BadChecksum);
  const EncoderLine crc{.checksum = LineChecksum::crc8};
  EXPECT_EQ(read_line("123456789*F4", crc).count, 123456789U);
  EXPECT_EQ(read_line("123456789*f4", crc).count, 123456789U);
  read_line("123456780*F4", crc, PlateFailure::BadChecksum);
  EXPECT_EQ(read_line("12*00", {}).count, 12U) << "not checked";
}

TEST(EncoderLine, RefusesWhatIsNoReading) {
  const EncoderLine format{.begin = "E", .count_column = 2, .time_column = 1};
  read_line("F1,2", format, PlateFailure::OtherSentence);
  for (const auto* line :
       {"E", "E1", "E1,", "E1,x", "E1,2.5", "Enan,2", "E1e300,2", "E1,99999999999999999999"}) {
    read_line(line, format, PlateFailure::BadField);
  }
}

TEST(PlateFramer, ReadsLinesOfTheUsersOwnFormatHoweverTheStreamIsCut) {
  const std::string text = "56,7\r\n100,1\n200,2\r\n\nrubbish\n" + sentence(9) + "300,3\n400,4";
  for (std::size_t piece = 1; piece <= text.size(); ++piece) {
    PlateFramer framer(EncoderLine{.count_column = 2, .time_column = 1});
    std::vector<std::uint32_t> times;
    for (std::size_t i = 0; i < text.size(); i += piece)
      framer.feed(as_bytes(std::string_view(text).substr(i, piece)), 0,
                  [&](const PlateReading& r) { times.push_back(r.device_us); });
    framer.gap();
    EXPECT_THAT(times, ElementsAre(100, 200, 4294967295U, 300)) << "the first line may have lost its begin";
    EXPECT_EQ(framer.counts().skipped_bytes, 5U);
    EXPECT_EQ(framer.counts().of(PlateFailure::BadField), 1U);
    EXPECT_EQ(framer.counts().of(PlateFailure::Truncated), 1U);
  }
}

TEST(PlateFramer, TakesADatagramsLastLineWithoutALineFeed) {
  PlateFramer framer(EncoderLine{}, PlateBytes::datagrams);
  std::vector<PlateReading> readings;
  const auto take = [&](const PlateReading& r) { readings.push_back(r); };
  for (const std::int64_t ms : {7, 8}) {
    framer.feed(as_bytes(std::string_view("5\n6")), ms * 1'000'000, take);
    framer.gap(take);
  }
  ASSERT_EQ(readings.size(), 4U);
  EXPECT_EQ(readings[3].count, 6U);
  EXPECT_EQ(readings[3].device_us, 8000U) << "the receipt, without a time of its own";
  EXPECT_EQ(readings[3].sequence, 3);
  EXPECT_FALSE(readings[3].numbered);
}

TEST(PlateFramer, BoundsALineOfTheUsersOwnFormat) {
  PlateFramer framer(EncoderLine{}, PlateBytes::datagrams);
  std::size_t readings = 0;
  const auto take = [&](const PlateReading&) { ++readings; };
  framer.feed(as_bytes(std::string(100'000, '1') + "\n5\n"), 0, take);
  EXPECT_EQ(readings, 1U);
  EXPECT_EQ(framer.counts().of(PlateFailure::Truncated), 1U);
}

}  // namespace
}  // namespace crisp
