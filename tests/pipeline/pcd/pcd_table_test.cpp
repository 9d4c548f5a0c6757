// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <crisp/cloud_conversion.hpp>
#include <crisp/error.hpp>
#include <crisp/pcd_table.hpp>

#include "tests/pipeline/pcd/sample_tables.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using testing::HasSubstr;

std::string written(const PcdTable& table, PcdFormat format) {
  const test::TemporaryFolder folder;
  AtomicFile out(folder / "table.pcd");
  write_pcd(out, table, format);
  out.commit();
  return test::bytes_of(out.path());
}

/// The error of parse_pcd for a file; empty if it is valid.
std::string complaint(std::string_view bytes) {
  try {
    parse_pcd(bytes, "x.pcd");
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

std::string ascii_file(const std::string& header, const std::string& data) {
  return header + "\nDATA ascii\n" + data;
}

class PcdFormats : public testing::TestWithParam<PcdFormat> {};

TEST_P(PcdFormats, TheSamePointsGiveTheSameBytes) {
  const auto cloud = test::sample_cloud(5000);
  EXPECT_EQ(written(to_pcd_table(cloud), GetParam()), written(to_pcd_table(cloud), GetParam()));
}

TEST_P(PcdFormats, AFileThatIsCutOffAnywhereIsRefused) {
  const std::string bytes = written(to_pcd_table(test::sample_cloud(7)), GetParam());
  ASSERT_EQ(complaint(bytes), "");
  // What ends an ASCII file is a line break, which is not missed; without its last digit a number is another.
  const std::size_t longest = bytes.size() - (GetParam() == PcdFormat::ascii ? 20 : 0);
  for (std::size_t n = 0; n < longest; ++n) ASSERT_NE(complaint(bytes.substr(0, n)), "") << n;
}

TEST_P(PcdFormats, AFlippedBitNeverBringsTheReaderDown) {
  std::string bytes = written(to_pcd_table(test::sample_cloud(7)), GetParam());
  std::size_t refused = 0;
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    const auto flip = static_cast<char>(1 << (bit % 8));
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ flip);
    refused += complaint(bytes).empty() ? 0 : 1;
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ flip);
  }
  EXPECT_GT(refused, 0U);
}

INSTANTIATE_TEST_SUITE_P(All, PcdFormats,
                         testing::Values(PcdFormat::ascii, PcdFormat::binary, PcdFormat::binary_compressed));

TEST(PcdTable, MistakesInAHeaderAreNamedWithTheirLine) {
  const std::string fields = "VERSION 0.7\nFIELDS x y\n";
  EXPECT_THAT(complaint("VERSION 0.7\nFIELDS x\n"), HasSubstr("x.pcd:3:1: error: the file ends before"));
  EXPECT_THAT(complaint(ascii_file(fields + "SIZE 4", "")),
              HasSubstr("x.pcd:3:1: error: SIZE has 1 values for 2"));
  EXPECT_THAT(complaint(ascii_file(fields + "SIZE 4 3\nWIDTH 1", "1 2")), HasSubstr("has 3 bytes"));
  EXPECT_THAT(complaint(ascii_file(fields + "SIZE 4 2\nWIDTH 1", "1 2")), HasSubstr("type F has 2 bytes"));
  EXPECT_THAT(complaint(ascii_file(fields + "WIDTH 1", "1 2")), HasSubstr("has 0 bytes"));
  EXPECT_THAT(complaint(ascii_file(fields + "SIZE 4 -4", "")), HasSubstr("'-4' is no whole number"));
  EXPECT_THAT(complaint(ascii_file(fields + "TYPE F X", "")), HasSubstr("no type 'X'"));
  EXPECT_THAT(complaint(ascii_file(fields + "COUNT 1 0", "")), HasSubstr("COUNT must be"));
  EXPECT_THAT(complaint(ascii_file(fields + "SIZE 4 4\nWIDTH 2\nHEIGHT 2\nPOINTS 5", "")),
              HasSubstr("POINTS is not WIDTH times HEIGHT"));
  EXPECT_THAT(
      complaint(ascii_file(fields + "SIZE 4 4\nWIDTH 4294967296\nHEIGHT 4294967297\nPOINTS 4294967296", "")),
      HasSubstr("too large"));
  EXPECT_THAT(complaint(ascii_file(fields + "FOO 1", "")), HasSubstr("'FOO' is no key"));
  EXPECT_THAT(complaint(fields + "DATA zip\n"), HasSubstr("DATA must be"));
  EXPECT_THAT(complaint(ascii_file("SIZE 4", "")), HasSubstr("for 0 fields"));
  EXPECT_THAT(complaint(ascii_file("WIDTH 1", "")), HasSubstr("FIELDS is missing"));
}

TEST(PcdTable, PointsThatAreNotThereAreNotAllocated) {
  const std::string header = "FIELDS x\nSIZE 8\nTYPE F\nWIDTH 1000000000000000\n";
  EXPECT_THAT(complaint(header + "DATA ascii\n1\n"), HasSubstr("too short"));
  EXPECT_THAT(complaint(header + "DATA binary\n12345678"), HasSubstr("too short"));
  EXPECT_THAT(complaint(header + std::string("DATA binary_compressed\n\1\0\0\0\10\0\0\0x", 32)),
              HasSubstr("too short"));
}

TEST(PcdTable, AnAsciiFileOfAnotherProgramIsRead) {
  const auto table = parse_pcd(
      "VERSION .7\r\nCOLUMNS x flag n big\r\nSIZE 4 1 2 8\r\nTYPE F U I I\r\nCOUNT 1 1 2 1\r\nWIDTH 2\r\nDATA ascii\r\n"
      "nan 255 -1 2 -9007199254740993\r\n 1e-60\t7 3 4 5",
      "x.pcd");
  EXPECT_TRUE(std::isnan(table.column<float>("x").at(0)));
  EXPECT_EQ(table.column<float>("x").at(1), 0);
  EXPECT_EQ(table.column<std::uint16_t>("flag"), (std::vector<std::uint16_t>{255, 7}));
  EXPECT_EQ(table.column<double>("big").at(1), 5);
}

TEST(PcdTable, AFileOfVersion5WithoutSizesIsRead) {
  const auto table = parse_pcd("VERSION .5\nCOLUMNS x y z\nPOINTS 2\nDATA ascii\n1 2 3\n4 5 6.5\n", "x.pcd");
  EXPECT_EQ(table.column<float>("z"), (std::vector<float>{3, 6.5F}));
  EXPECT_THAT(complaint("VERSION 0.7\nFIELDS x\nPOINTS 1\nDATA ascii\n1\n"), HasSubstr("0 bytes"));
}

TEST(PcdTable, TypesInSmallLettersAreRead) {
  const auto table = parse_pcd(ascii_file("FIELDS x n\nSIZE 4 2\nTYPE f u\nWIDTH 1", "1.5 7\n"), "x.pcd");
  EXPECT_EQ(table.column<std::uint16_t>("n"), (std::vector<std::uint16_t>{7}));
  EXPECT_THAT(complaint(ascii_file("FIELDS x\nSIZE 4\nTYPE FI\nWIDTH 1", "1\n")), HasSubstr("no type 'FI'"));
}

TEST(PcdTable, NumbersAreReadHoweverTheyAreWritten) {
  const auto table = parse_pcd(
      ascii_file("FIELDS x n\nSIZE 4 2\nTYPE F I\nWIDTH 4", "+1.5 4.0\n.25 +7\n1e-1 -2e1\n-3E2 0.0\n"),
      "x.pcd");
  EXPECT_EQ(table.column<float>("x"), (std::vector<float>{1.5F, 0.25F, 0.1F, -300}));
  EXPECT_EQ(table.column<double>("n"), (std::vector<double>{4, 7, -20, 0}));
  for (const auto* wrong : {"4.5", "+-4", "1e9", "+", "4.0x"}) {
    EXPECT_THAT(complaint(ascii_file("FIELDS n\nSIZE 2\nTYPE I\nWIDTH 1", std::string(wrong) + "\n")),
                HasSubstr("in place of a number"))
        << wrong;
  }
}

TEST(PcdTable, FieldsInCapitalsAreACloudsToo) {
  const auto table = parse_pcd(
      ascii_file("FIELDS X Y Z Intensity GpsTime\nSIZE 4 4 4 4 8\nTYPE F F F F F\nWIDTH 1", "1 2 3 4 5\n"),
      "x.pcd");
  const auto cloud = cloud_of(table).cloud;
  EXPECT_EQ(cloud->at(0).y, 2);
  EXPECT_EQ(cloud->at(0).intensity, 4);
  EXPECT_THAT(
      dropped_fields(table),
      testing::ElementsAre("the fields GpsTime (rename the points' times to 'time' in FIELDS to keep them)"));
}

TEST(PcdTable, AValueThatIsNotANumberIsShown) {
  EXPECT_THAT(complaint(ascii_file("FIELDS x\nSIZE 4\nWIDTH 2", "1\ntwo\n")),
              HasSubstr("'two' in place of a number, in point 2"));
  EXPECT_THAT(complaint(ascii_file("FIELDS x\nSIZE 1\nTYPE U\nWIDTH 1", "256\n")), HasSubstr("'256'"));
}

TEST(PcdTable, AnAsciiLineOfMoreOrFewerValuesThanAPointHasIsRefusedWithItsPlace) {
  const std::string header = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 3";
  EXPECT_THAT(complaint(ascii_file(header, "1 2 3\n\n4 5 6 7\n8 9 10\n")),
              HasSubstr("x.pcd:9:1: error: the line has 4 values, where a point has 3;"));
  EXPECT_THAT(complaint(ascii_file(header, "1 2 3\n4 5 6\n7 8 9 10")),
              HasSubstr("x.pcd:9:1: error: the line has 4 "));
  EXPECT_THAT(complaint(ascii_file(header, "1 2 3\n4 5\n6 7 8 9\n")),
              HasSubstr("x.pcd:8:1: error: the line has 2 values, where a point has 3;"));
  EXPECT_THAT(complaint(ascii_file(header, "1.000 2.0 3.0000\n4.0000 5 6\n\n")),
              HasSubstr("ends after 2 of its 3 points"));
}

TEST(PcdTable, PointsBeyondThoseOfTheHeaderAreCounted) {
  const std::string ascii = "FIELDS x n\nSIZE 4 2\nTYPE F U\nWIDTH 1";
  EXPECT_EQ(parse_pcd(ascii_file(ascii, "1 2\n"), "x.pcd").surplus(), 0U);
  EXPECT_EQ(parse_pcd(ascii_file(ascii, "1 2\n3 4\n\n5 6"), "x.pcd").surplus(), 2U);
  const std::string binary = ascii + "\nDATA binary\n" + std::string(6, '\0');
  EXPECT_EQ(parse_pcd(binary, "x.pcd").surplus(), 0U);
  EXPECT_EQ(parse_pcd(binary + "\n", "x.pcd").surplus(), 0U)
      << "a line break that an editor added is no point";
  EXPECT_EQ(parse_pcd(binary + std::string(18, '\0'), "x.pcd").surplus(), 3U);
}

TEST(PcdTable, WhatIsNoPcdDoesNothingToATerminal) {
  const auto said_of = [](const std::string& bytes) {
    std::string text = complaint(bytes);
    for (const char c : text) EXPECT_FALSE(static_cast<unsigned char>(c) < 0x20 || c == 0x7f) << text;
    return text;
  };
  EXPECT_THAT(said_of("VERSION 0.7\nab\x1b[31mc\n"),
              HasSubstr("x.pcd:2:3: error: there is a control character (0x1b);"));
  EXPECT_THAT(said_of(std::string("\x7f"
                                  "ELF\0\0\n",
                                  7)),
              HasSubstr("x.pcd:1:1: error: there is a control"));
  EXPECT_THAT(said_of("\x8b\xe9\n"), HasSubstr("'\\x8b\\xe9' is no key of PCD;"));
  EXPECT_THAT(said_of(ascii_file("FIELDS x\nSIZE 4\nWIDTH 1", std::string("\0\x1b[2J", 5))),
              HasSubstr("x.pcd:5:1: error: the line has '\\x00\\x1b[2J' in place of a number, in point 1"));
}

TEST(PcdTable, ColumnsAreRefusedThatAreNotThereOrDoNotFit) {
  const auto table = parse_pcd(ascii_file("FIELDS x n\nSIZE 4 4\nTYPE F I\nWIDTH 1", "1 70000\n"), "x.pcd");
  EXPECT_THROW(table.column<float>("y"), Error);
  EXPECT_THROW(table.column<std::uint16_t>("n"), Error);
  EXPECT_EQ(table.column<float>("n").at(0), 70000);
}

TEST(PcdTable, PointsWithoutAPlaceAreCountedAndLeftOut) {
  const auto table =
      parse_pcd(ascii_file("FIELDS x y z\nSIZE 4 4 4\nWIDTH 3", "1 2 3\nnan nan nan\ninf 0 0\n"), "x.pcd");
  const auto read = cloud_of(table);
  EXPECT_EQ(read.cloud->size(), 1U);
  EXPECT_EQ(read.not_finite, 2U);
}

}  // namespace
}  // namespace crisp
