// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/plot/plot.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <iterator>
#include <sstream>

#include "pipeline/files/yaml.hpp"
#include "pipeline/plot/write_plot.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(Plot, DrawsItsSeriesWithinItsFrameAndNamesThem) {
  const std::string svg = as_svg({{.title = "a < b",
                                   .x_label = "x [m]",
                                   .y_label = "y [mm]",
                                   .series = {{.name = "first", .x = {0, 1, 2}, .y = {1, std::nan(""), 3}},
                                              {.name = "dots", .x = {1}, .y = {2}, .joined = false}}}});
  EXPECT_THAT(svg, HasSubstr("a &lt; b"));
  for (const char* text : {"x [m]", "y [mm]", ">first<", ">dots<", "<circle", "</svg>"})
    EXPECT_THAT(svg, HasSubstr(text));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(Plot, OfNothingIsAnEmptyFrame) {
  const std::string svg = as_svg({Plot{}});
  EXPECT_THAT(svg, HasSubstr("</svg>"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, Not(HasSubstr("inf")));
}

/// The numbers that follow `before` in the text, up to `after`.
std::vector<double> numbers_between(const std::string& text, const std::string& before, const char* after) {
  const auto begin = text.find(before) + before.size();
  std::string part = text.substr(begin, text.find(after, begin) - begin);
  for (char& c : part) {
    if (c == 'M' || c == 'L' || c == 'V') c = ' ';
  }
  std::istringstream stream(part);
  return {std::istream_iterator<double>(stream), {}};
}

TEST(Plot, PutsHigherValuesHigherUpAndBarsAroundThem) {
  const std::string svg =
      as_svg({{.series = {{.name = "s", .x = {0, 1, 2}, .y = {0, 10, 0}, .error = {0, 2, 0}}}}});
  const std::string drawn = svg.substr(svg.find("<rect x="));  // past the marks
  const auto line = numbers_between(drawn, "<path d=\"", "\"");
  ASSERT_EQ(line.size(), 6U) << "three points";
  EXPECT_NEAR(line[2], (line[0] + line[4]) / 2, 0.11) << "the middle one, pixels having one decimal";
  EXPECT_LT(line[3], line[1]) << "pixels count downwards";
  EXPECT_EQ(line[1], line[5]);
  const auto bar = numbers_between(drawn, "stroke-width=\"1.6\"/>\n<path d=\"", "\"");
  ASSERT_EQ(bar.size(), 3U);
  EXPECT_NEAR(bar[1] - bar[2], 0.4 * (line[1] - line[3]), 0.3) << "from 8 to 12 of 10";
}

TEST(Plot, OfSeveralStandTwoInARow) {
  const std::string svg = as_svg({{.title = "one"}, {.title = "two"}, {.title = "three"}});
  for (const char* text : {R"(width="1280" height="800")", "translate(0,0)", "translate(640,0)",
                           "translate(0,400)", ">three<"}) {
    EXPECT_THAT(svg, HasSubstr(text));
  }
}

TEST(Plot, IsWrittenAndTold) {
  const test::TemporaryFolder folder;
  RunSettings run;
  StageReport report;
  Context context(run, report);
  write_plots(folder / "deep/plot.svg", {{.title = "one"}}, context);
  EXPECT_THAT(report.written, testing::ElementsAre(folder / "deep/plot.svg"));
  EXPECT_EQ(read_text_file(folder / "deep/plot.svg", 1 << 20), as_svg({{.title = "one"}}));
}

}  // namespace
}  // namespace crisp
