// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/table/encoder_lines.hpp"

#include <gmock/gmock.h>

#include <sstream>
#include <vector>

#include <crisp/atomic_file.hpp>

#include "grabbers/table/encoder_lines_stage.hpp"
#include "grabbers/wire/plate_sentence.hpp"
#include "tests/support/stage_driver.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::table;
using namespace crisp::wire;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

const EncoderLine kFormat{.begin = "ENC", .count_column = 2, .time_column = 1};

/// The readings in a text, and what was left out.
struct ReadLines {
  std::vector<PlateReading> readings;
  std::map<std::string, std::uint64_t> losses;
  std::string fault;
};

ReadLines read_lines(const std::string& text, const std::optional<EncoderLine>& own,
                     std::optional<TimeUnit> stamp = {}) {
  std::istringstream in(text);
  EncoderLines lines(in, "lines.txt", own, stamp);
  ReadLines read;
  while (const auto reading = lines.next()) read.readings.push_back(*reading);
  read.losses = lines.losses();
  if (lines.first_fault())
    read.fault = to_string(lines.first_fault()->place()) + ": " + lines.first_fault()->message();
  return read;
}

TEST(EncoderLines, ReadsTheFormatOfTheRig) {
  const auto [readings, losses, fault] = read_lines("ENC,1000,-3\r\nENC,3500,7\n", kFormat);
  ASSERT_EQ(readings.size(), 2U);
  EXPECT_EQ(readings[0].count, 4'294'967'293U);
  EXPECT_EQ(readings[1].device_us, 3500U);
  EXPECT_EQ(readings[1].receipt_ns - readings[0].receipt_ns, 2'500'000) << "its own time";
  EXPECT_THAT(losses, ElementsAre());
}

TEST(EncoderLines, ContinuesAClockOf32BitsOverItsWraps) {
  const auto read = read_lines("ENC,4294967000,1\nENC,704,2\nENC,4294967000,3\n", kFormat);
  ASSERT_EQ(read.readings.size(), 2U);
  EXPECT_EQ(read.readings[1].receipt_ns - read.readings[0].receipt_ns, 1'000'000);
  EXPECT_THAT(read.losses, ElementsAre(Pair("lines that are not later than the one before", 1)));
  EXPECT_EQ(read.fault, "lines.txt:3:1: lines that are not later than the one before");
}

TEST(EncoderLines, TakesTheTimesOfReceiptOfALogger) {
  constexpr const char* kText = "1700000000.123456789 ENC,1000,1\nENC,2000,2\n1700000000.5,ENC,3000,3\n";
  const auto read = read_lines(kText, kFormat, TimeUnit::s);
  ASSERT_EQ(read.readings.size(), 2U);
  EXPECT_EQ(read.readings[0].receipt_ns, 1'700'000'000'123'456'789);
  EXPECT_EQ(read.readings[0].device_us, 1000U);
  EXPECT_EQ(read.readings[1].receipt_ns, 1'700'000'000'500'000'000);
  EXPECT_THAT(read.losses, ElementsAre(Pair("lines without a time of receipt", 1)));
  const auto untimed = read_lines("1700000000500 17\n", EncoderLine{}, TimeUnit::ms);
  EXPECT_EQ(untimed.readings.at(0).receipt_ns, 1'700'000'000'500'000'000);
  EXPECT_EQ(untimed.readings[0].count, 17U);
}

TEST(EncoderLines, CountsDamagedLinesAndThoseOfOthers) {
  EncoderLine checked = kFormat;
  checked.checksum = LineChecksum::exclusive_or;  // of "ENC,1,2": 0x4B
  const auto read = read_lines("hello\nENC,1,2*4B\n\nENC,2,2*4B\n", checked);
  EXPECT_EQ(read.readings.size(), 1U);
  EXPECT_THAT(read.losses, ElementsAre(Pair("lines that are not of the encoder", 1),
                                       Pair("lines with a wrong checksum", 1)));
  EXPECT_THAT(read.fault, HasSubstr("lines.txt:4:1"));
}

TEST(EncoderLines, ReadsTheBuiltInSentenceWithItsNumbers) {
  const std::string sentence = encode_plate_sentence({.sequence = 65'535, .device_us = 5, .count = 6});
  const auto read = read_lines(sentence + sentence, std::nullopt);
  ASSERT_EQ(read.readings.size(), 1U) << "the second is no later";
  EXPECT_EQ(read.readings[0].sequence, 65'535);
  EXPECT_TRUE(read.readings[0].numbered);
}

class EncoderLinesStageTest : public testing::Test {
 protected:
  test::StageDriver stage(const std::string& text, std::map<std::string, OptionValue> options = {}) {
    write_file(folder_ / "lines.txt", text);
    options.emplace("file", OptionScalar((folder_ / "lines.txt").string()));
    auto driver = test::StageDriver::of<EncoderLinesStage>(options);
    driver.run().rig.plate.line = line_;
    return driver;
  }

  test::TemporaryFolder folder_;
  EncoderLine line_ = kFormat;
};

TEST_F(EncoderLinesStageTest, GivesScansAndReadingsInTheOrderOfTheirReceipt) {
  auto lines = stage("1.0 ENC,1000,1\n2.0 ENC,2000,2\n4.0 ENC,4000,4\n",
                     {{"stamp_unit", OptionScalar(std::string("s"))}});
  for (const std::int64_t seconds : {2, 3}) {
    Scan scan;
    scan.receipt_ns = seconds * 1'000'000'000;
    lines.feed(scan);
    EXPECT_EQ(lines.given<PlateReading>().size(), 2U);
  }
  EXPECT_EQ(lines.given<Scan>().size(), 2U);
  lines.finish();
  EXPECT_EQ(lines.given<PlateReading>().size(), 3U);
}

TEST_F(EncoderLinesStageTest, GivesReadingsAndNamesTheFirstDamagedLine) {
  auto lines = stage("ENC,1000,1\nENC,x,1\nENC,3000,2\n");
  lines.finish();
  EXPECT_EQ(lines.given<PlateReading>().size(), 2U);
  EXPECT_THAT(lines.report().warnings,
              ElementsAre(HasSubstr("lines.txt:2:1: here is the first of the lines with a field")));
}

TEST_F(EncoderLinesStageTest, RefusesAFileWithoutOneLine) {
  for (const auto& [text, expected] :
       {std::pair("ENC,x\n", "lines.txt:1:1: "), std::pair("hello\n", "holds no line")}) {
    try {
      stage(text).finish();
      FAIL() << text;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr(expected));
    }
  }
}

TEST_F(EncoderLinesStageTest, LinesNeedATimeOfTheirOwnOrOfReceipt) {
  line_.time_column.reset();
  EXPECT_THROW(stage("").check(), Error);
  EXPECT_NO_THROW(stage("", {{"stamp_unit", OptionScalar(std::string("s"))}}).check());
}

}  // namespace
}  // namespace crisp
