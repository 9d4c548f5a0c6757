// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/app/progress.hpp"

#include <gmock/gmock.h>

#include <sstream>

#include "pipeline/app/format.hpp"

namespace crisp {
namespace {

using namespace crisp::app;

struct ProgressTest : testing::Test {
  double now = 100;
  std::ostringstream out;
  ProgressPrinter::Clock clock = [this] { return now; };
};

TEST_F(ProgressTest, RefreshesOneLineOfATerminalWithBarRateAndTimeLeft) {
  {
    ProgressPrinter printer(out, true, clock);
    printer.show("read", {.done = 0, .total = 400e6, .unit = "B"});
    now += 0.05;
    printer.show("read", {.done = 1e6, .total = 400e6, .unit = "B"});  // too soon to be shown
    now += 1.95;
    printer.show("read", {.done = 100e6, .total = 400e6, .unit = "B", .what = "packets"});
  }
  EXPECT_EQ(
      out.str(),
      "\r\x1b[Kread                   [                        ]   0 %\r\x1b[Kread                   [######                  ]  25 %  50 MB/s  6.0 s left  packets\r\x1b[K");
}

TEST_F(ProgressTest, CutsTheLineBeforeTheLastColumnOfTheTerminal) {
  {
    ProgressPrinter printer(out, true, clock, 67);
    printer.show("calibrate.refine", {.done = 0.25, .what = "σ 5 cm, λ and τ"});
  }
  EXPECT_EQ(out.str(), "\r\x1b[Kcalibrate.refine       [######                  ]  25 %  σ 5 cm, λ\r\x1b[K");
}

TEST_F(ProgressTest, PrintsPlainLinesAtMostEveryTenSecondsElsewhere) {
  {
    ProgressPrinter printer(out, false, clock);
    for (int i = 0; i <= 200; ++i, now += 0.125) printer.show("read", {.done = i / 200.0});
    printer.show("write", {.done = 0.5});
  }
  EXPECT_EQ(out.str(),
            "read                     0 %\n"
            "read                    40 %  15.0 s left\n"
            "read                    80 %  5.0 s left\n"
            "write                   50 %\n");
}

TEST_F(ProgressTest, EstimatesTheTimeLeftOfAPartThatBeginsAnew) {
  ProgressPrinter printer(out, true, clock);
  printer.show("calibrate.refine", {.done = 0});
  now += 60;
  printer.show("calibrate.refine", {.done = 0.9});
  now += 1;
  printer.show("calibrate.refine", {.done = 0.1, .what = "what if"});
  now += 2;
  printer.show("calibrate.refine", {.done = 0.2, .what = "what if"});
  EXPECT_THAT(out.str(), testing::EndsWith(" 20 %  16.0 s left  what if"));
}

TEST_F(ProgressTest, SurvivesFiguresThatMakeNoSense) {
  ProgressPrinter printer(out, false, clock);
  printer.show("a", {.done = 5, .total = 0});
  printer.show("b", {.done = std::nan(""), .total = 1});
  printer.show("c", {.done = -1, .total = 1});
  printer.show("d", {.done = 7, .total = 1});
  EXPECT_EQ(out.str(),
            "a                        0 %\nb                        0 %\n"
            "c                        0 %\nd                      100 %\n");
}

TEST(Format, WritesFiguresAsPeopleReadThem) {
  EXPECT_EQ(format_duration(0.0123), "12 ms");
  EXPECT_EQ(format_duration(3.44), "3.4 s");
  EXPECT_EQ(format_duration(59.99), "1 min 0 s");
  EXPECT_EQ(format_duration(3780), "1 h 3 min");
  EXPECT_EQ(format_duration(std::nan("")), "?");
  EXPECT_EQ(format_amount(152e6, "B"), "152 MB");
  EXPECT_EQ(format_amount(1234, "points"), "1.2 k points");
  EXPECT_EQ(format_amount(7, "points"), "7 points");
  EXPECT_EQ(format_count(0), "0");
  EXPECT_EQ(format_count(123), "123");
  EXPECT_EQ(format_count(1234567), "1 234 567");
}

TEST(Format, CutsATextBetweenCharacters) {
  EXPECT_EQ(first_columns("σ 5 cm", 1), "σ");
  EXPECT_EQ(first_columns("σ 5 cm", 0), "");
  EXPECT_EQ(first_columns("σ 5 cm", 6), "σ 5 cm");
  EXPECT_EQ(first_columns("σ", 80), "σ");
  EXPECT_EQ(first_columns("\x80\x80", 1), "\x80\x80");
}

}  // namespace
}  // namespace crisp
