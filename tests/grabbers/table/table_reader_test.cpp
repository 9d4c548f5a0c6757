// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/table/table_reader.hpp"

#include <gmock/gmock.h>

#include <sstream>
#include <stdexcept>
#include <streambuf>

#include "grabbers/table/decimal.hpp"
#include "pipeline/data/degree.hpp"

namespace crisp {
namespace {

using namespace crisp::data;
using namespace crisp::table;
using testing::ElementsAre;
using testing::FloatEq;
using testing::IsEmpty;
using testing::Pair;

struct Read {
  std::vector<TableRow> rows;
  std::map<std::string, std::uint64_t> losses;
  std::string fault;
};

Read read(const std::string& text, const TableFormat& format) {
  std::istringstream in(text);
  TableReader reader(in, "t.csv", format);
  Read all;
  while (auto row = reader.next()) all.rows.push_back(*row);
  all.losses = reader.losses();
  if (reader.first_fault()) all.fault = reader.first_fault()->what();
  return all;
}

constexpr TableFormat kPlain{.time_column = 1, .angle_column = 2, .range_column = 3};

TEST(TableReader, ReadsAScanARow) {
  const auto all = read("0.5,1.5,2.25,0,-1,4\n", kPlain);
  ASSERT_EQ(all.rows.size(), 1U);
  EXPECT_EQ(all.rows[0].time_ns, 500'000'000);
  EXPECT_EQ(all.rows[0].angle, 1.5);
  EXPECT_THAT(all.rows[0].ranges, ElementsAre(2.25F, 0.0F, 0.0F, 4.0F));
  EXPECT_THAT(all.losses, IsEmpty());
}

TEST(TableReader, ConvertsUnitsAndLeavesCodesOut) {
  const TableFormat format{.time_column = 9,
                           .time_unit = TimeUnit::us,
                           .receipt_column = 1,
                           .receipt_unit = TimeUnit::ns,
                           .counter_column = 2,
                           .angle_column = 3,
                           .angle_unit = AngleUnit::deg,
                           .range_column = 5,
                           .count_column = 4,
                           .range_unit = LengthUnit::cm,
                           .invalid_from = 8183};
  const auto all = read("1102823344562033212,254,90,3,150,8191,8182,77,3014133219\n", format);
  ASSERT_EQ(all.rows.size(), 1U);
  EXPECT_EQ(all.rows[0].time_ns, 3'014'133'219'000);
  EXPECT_EQ(all.rows[0].receipt_ns, 1102823344562033212);
  EXPECT_EQ(all.rows[0].counter, 254);
  EXPECT_DOUBLE_EQ(all.rows[0].angle, 90 * kDegree);
  EXPECT_THAT(all.rows[0].ranges, ElementsAre(FloatEq(1.5F), 0.0F, FloatEq(81.82F)));
}

TEST(TableReader, ReadsABeamARowWithItsLaserAndRemission) {
  const TableFormat format{.time_column = 1,
                           .angle_column = 2,
                           .range_column = 5,
                           .remission_column = 6,
                           .mirror_column = 4,
                           .laser_column = 3};
  const auto all = read("1 0.25 7 1.5 12.5 33\n", format);
  ASSERT_EQ(all.rows.size(), 1U);
  EXPECT_EQ(all.rows[0].laser, 7);
  EXPECT_EQ(all.rows[0].mirror, 1.5);
  EXPECT_THAT(all.rows[0].ranges, ElementsAre(12.5F));
  EXPECT_THAT(all.rows[0].remissions, ElementsAre(33.0F));
}

TEST(TableReader, PassesOverCommentsEmptyLinesAndNames) {
  EXPECT_EQ(
      read("time;angle;range\r\n# a remark\r\n\r\n0;0;1\r\n1\t0\t1\r\n2 , 0 , 1\r\n", kPlain).rows.size(),
      3U);
}

TEST(TableReader, ReadsASignAndAnExponentAnywhere) {
  const auto all = read("+1.5e+0,+2E-1,+3.5,-1\n", kPlain);
  ASSERT_EQ(all.rows.size(), 1U) << all.fault;
  EXPECT_EQ(all.rows[0].time_ns, 1'500'000'000);
  EXPECT_EQ(all.rows[0].angle, 0.2);
  EXPECT_THAT(all.rows[0].ranges, ElementsAre(3.5F, 0.0F));
}

TEST(TableReader, TakesAnEmptyRangeForNoEcho) {
  const auto all = read("0,0,1.5,,2.5\n1,0,,,2.5\n", kPlain);
  ASSERT_EQ(all.rows.size(), 2U) << all.fault;
  EXPECT_THAT(all.rows[0].ranges, ElementsAre(1.5F, 0.0F, 2.5F));
  EXPECT_THAT(all.rows[1].ranges, ElementsAre(0.0F, 0.0F, 2.5F));
  EXPECT_EQ(read(",0,1\n", kPlain).rows.size(), 0U) << "a time must be there";
}

TEST(TableReader, PassesOverNamesBehindAPercentSign) {
  const auto all = read("%time,field.angle,field.ranges0\n0,0,1\n", kPlain);
  EXPECT_EQ(all.rows.size(), 1U);
  EXPECT_THAT(all.losses, IsEmpty());
}

TEST(TableReader, ReadsTheActuatorsCounts) {
  const TableFormat format{.time_column = 1,
                           .angle_column = 2,
                           .angle_unit = AngleUnit::counts,
                           .angle_per_count = 0.001,
                           .range_column = 4,
                           .mirror_column = 3};
  const auto all = read("0,250,0.5,1\n", format);
  ASSERT_EQ(all.rows.size(), 1U);
  EXPECT_NEAR(all.rows[0].angle, 0.25, 1e-12);
  EXPECT_EQ(all.rows[0].mirror, 0.5) << "rad";
}

TEST(TableReader, CountsRowsThatCannotBeReadAndNamesTheFirst) {
  const auto all = read("0,0,1\n1,zero,1\n2,0\n3,0,x\n1e3x,0,1\n4,1e300,1\n5,0,1\n", kPlain);
  EXPECT_EQ(all.rows.size(), 2U);
  EXPECT_THAT(
      all.losses,
      ElementsAre(Pair("rows with a field that is no number", 2), Pair("rows with an impossible angle", 1),
                  Pair("rows with an impossible time or count", 1), Pair("rows with too few columns", 1)));
  EXPECT_THAT(all.fault, testing::HasSubstr("t.csv:2:3"));
}

TEST(TableReader, RefusesRowsWithFewerRangesThanTheirCount) {
  const TableFormat format{.angle_column = 1, .range_column = 3, .count_column = 2};
  EXPECT_THAT(read("0,3,1,1\n0,2,1,1\n0,-1,1\n", format).losses,
              ElementsAre(Pair("rows with fewer ranges than their count", 2)));
}

TEST(TableReader, ReadsLinesInWhateverWayTheyEndAndPassesOverAByteOrderMark) {
  EXPECT_EQ(read("0,0,1\r1,0,1\r2,0,1", kPlain).rows.size(), 3U);
  EXPECT_EQ(read("\xEF\xBB\xBF"
                 "0,0,1\r\n1,0,1\r\n",
                 kPlain)
                .rows.size(),
            2U);
  EXPECT_EQ(read("\xEF\xBB\xBFtime,angle,range\n0,0,1\n", kPlain).losses.size(), 0U);
  EXPECT_THAT(read("0,0,1\r\n\r\n1,0,x\r\n", kPlain).fault, testing::HasSubstr("t.csv:3:5"));
}

TEST(TableReader, ReadsOnAfterALineThatIsTooLong) {
  const auto all = read("0,0,1\n" + std::string(5 << 20, '1') + "\n1,0,1\n", kPlain);
  EXPECT_EQ(all.rows.size(), 2U);
  EXPECT_THAT(all.losses, ElementsAre(Pair("rows of more than 1 MiB", 1)));
}

TEST(TableReader, ReadsTheSameWhereverItsPiecesEnd) {
  std::string text;
  for (int row = 0; row < 20000; ++row) text += std::to_string(row) + ",0,1\r\n";
  EXPECT_EQ(read(text, kPlain).rows.size(), 20000U);
}

/// Gives a few bytes, then nothing but errors or zeros.
class Broken : public std::streambuf {
 public:
  explicit Broken(bool zeros) : zeros_(zeros) {
    setg(text_.data(), text_.data(), text_.data() + text_.size());
  }

 private:
  int underflow() override {
    if (!zeros_) throw std::runtime_error("the disk is broken");
    text_.assign(1 << 16, 0);
    setg(text_.data(), text_.data(), text_.data() + text_.size());
    return 0;
  }
  std::string text_ = "0,0,1\n";
  bool zeros_;
};

TEST(TableReader, ThrowsWhereTheTextCannotBeReadToItsEnd) {
  for (const bool zeros : {false, true}) {
    Broken broken(zeros);
    std::istream in(&broken);
    TableReader reader(in, "t.csv", kPlain);
    EXPECT_THROW(while (reader.next()){}, Error) << "a table that is cut off is not whole";
  }
}

TEST(ShiftedDecimal, IsExactWhereADoubleIsNot) {
  EXPECT_EQ(shifted_decimal("1436216345.302587750", 9), 1436216345302587750);
  EXPECT_EQ(shifted_decimal("-0.0000000015", 9), -2);
  EXPECT_EQ(shifted_decimal(".5", 3), 500);
  EXPECT_EQ(shifted_decimal("7", 0), 7);
  EXPECT_EQ(shifted_decimal("1.541000000250000000e+09", 9), 1541000000250000000);
  EXPECT_EQ(shifted_decimal("1.00000E+00", 0), 1);
  EXPECT_EQ(shifted_decimal("1.5e-3", 3), 2);
  EXPECT_EQ(shifted_decimal("-25e-1", 0), -3);
  EXPECT_EQ(shifted_decimal("1e-300", 9), 0);
  EXPECT_EQ(shifted_decimal("0e300", 0), 0);
  for (const char* no : {"", ".", "1e", "e3", "1e+-3", "1e999", "1e30", "0x1", "1.2.3", "--1",
                         "99999999999999999999", "nan"}) {
    EXPECT_EQ(shifted_decimal(no, 9), std::nullopt) << no;
  }
}

}  // namespace
}  // namespace crisp
