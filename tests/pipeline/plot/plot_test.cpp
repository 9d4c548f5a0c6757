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

using namespace crisp::files;
using namespace crisp::plot;
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

/// Where the frame of a picture of one plot begins, and where its text of that name stands [pixels from
/// above].
double top_of_frame(const std::string& svg) {
  return numbers_between(svg, R"(<rect x="70" y=")", "\"").at(0);
}
double height_of_name(const std::string& svg, const std::string& name) {
  const auto begin = svg.rfind("<text", svg.find(">" + name + "<"));
  return numbers_between(svg.substr(begin), " y=\"", "\"").at(0);
}

TEST(Plot, NamesItsSeriesAboveItsFrameInAsManyRowsAsTheyTake) {
  Plot plot{.title = "t", .series = {{.name = "one", .x = {0, 1}, .y = {0, 1}}}};
  const std::string one = as_svg({plot});
  EXPECT_LT(height_of_name(one, "one"), top_of_frame(one));
  EXPECT_GT(height_of_name(one, "one"), height_of_name(one, "t"));
  plot.series.push_back({.name = std::string(60, 'a'), .x = {0}, .y = {1}});
  plot.series.push_back({.name = std::string(60, 'b'), .x = {0}, .y = {1}});
  const std::string three = as_svg({plot});
  EXPECT_EQ(height_of_name(three, "one"), height_of_name(three, std::string(60, 'a')));
  EXPECT_LT(height_of_name(three, "one"), height_of_name(three, std::string(60, 'b')));
  EXPECT_LT(height_of_name(three, std::string(60, 'b')), top_of_frame(three));
  EXPECT_GT(top_of_frame(three), top_of_frame(one));
}

std::size_t times_in(const std::string& text, const std::string& what) {
  std::size_t times = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++times;
  return times;
}

/// The drawing within the frame of a picture of one plot.
std::string within_frame(const std::string& svg) { return svg.substr(svg.find("<rect x=")); }

TEST(Plot, BreaksALineWhereThereIsNoNumber) {
  const double none = std::nan("");
  const std::string svg =
      within_frame(as_svg({{.series = {{.name = "s", .x = {0, 1, 2, 3, 4}, .y = {1, 2, none, 3, 4}}}}}));
  const std::string line = svg.substr(svg.find("<path d=\""), svg.find("fill=") - svg.find("<path d=\""));
  EXPECT_EQ(times_in(line, "M"), 2U);
  EXPECT_EQ(times_in(line, "L"), 2U);
  EXPECT_EQ(times_in(svg, "<circle"), 0U);
}

TEST(Plot, ShowsAPointThatHasNobodyToBeJoinedTo) {
  const double none = std::nan("");
  const std::string svg =
      within_frame(as_svg({{.series = {{.name = "s", .x = {0, 1, 2, 3}, .y = {1, none, 3, 4}}}}}));
  EXPECT_EQ(times_in(svg, "<circle"), 1U);
}

TEST(Plot, PutsKindsSideBySideUnderTheirNamesAndJoinsNone) {
  const std::string svg = as_svg({{.series = {{.name = "s", .x = {0, 1}, .y = {1, 2}, .error = {0.1, 0.1}},
                                              {.name = "t", .x = {0, 1}, .y = {1, 2}, .error = {0.1, 0.1}}},
                                   .kinds = {{.at = 0, .name = "front"}, {.at = 1, .name = "back"}}}});
  for (const char* text : {">front<", ">back<"}) EXPECT_THAT(svg, HasSubstr(text));
  EXPECT_THAT(svg, Not(HasSubstr(">0.5<"))) << "between two kinds there is nothing";
  const std::string drawn = within_frame(svg);
  EXPECT_EQ(times_in(drawn, "<circle"), 4U);
  EXPECT_THAT(drawn, Not(HasSubstr("L"))) << "no line";
  const double one = numbers_between(drawn, "<circle cx=\"", "\"").at(0);
  const double other = numbers_between(drawn.substr(drawn.rfind("<path")), "<circle cx=\"", "\"").at(0);
  EXPECT_GT(other, one + 5) << "neither hides the other";
}

TEST(Plot, HasDecadesOnALogarithmicAxis) {
  const std::string svg =
      as_svg({{.series = {{.name = "s", .x = {1, 2, 3, 4}, .y = {0.001, 0.1, 10, 0}, .error = {0.002}}},
               .y_scale = PlotScale::logarithmic}});
  for (const char* mark : {">0.001<", ">0.01<", ">0.1<", ">1<", ">10<"}) EXPECT_THAT(svg, HasSubstr(mark));
  EXPECT_THAT(svg, Not(HasSubstr(">0<"))) << "which has no place there";
  const auto line = numbers_between(within_frame(svg), "<path d=\"", "\"");
  ASSERT_EQ(line.size(), 6U) << "the three that have a logarithm";
  EXPECT_NEAR(line[3], (line[1] + line[5]) / 2, 0.11);
  const auto bar = numbers_between(within_frame(svg), "stroke-width=\"1.6\"/>\n<path d=\"", "\"");
  EXPECT_LE(bar.at(1), 400 - 50) << "a bar that reaches below nothing ends at the frame";
}

TEST(Plot, MarksWhatWasFound) {
  const std::string svg = as_svg({{.series = {{.name = "s", .x = {0, 2}, .y = {0, 1}}},
                                   .marks = {{.at = 1, .around = 0.1, .name = "found"}}}});
  EXPECT_THAT(svg, HasSubstr(">found<"));
  const auto line = numbers_between(within_frame(svg), "<path d=\"", "\"");
  const auto mark = svg.find("stroke-dasharray", svg.find(">found<"));
  ASSERT_NE(mark, std::string::npos);
  const auto dashed = numbers_between(svg.substr(svg.rfind("<path", mark)), "d=\"", "\"");
  EXPECT_NEAR(dashed.at(0), (line.at(0) + line.at(2)) / 2, 0.11) << "half way from 0 to 2";
  const std::string beyond =
      as_svg({{.series = {{.name = "s", .x = {0, 1}, .y = {0, 1}}}, .marks = {{.at = 3, .name = "m"}}}});
  EXPECT_THAT(beyond, HasSubstr(">3<")) << "the axis reaches there";
}

TEST(Plot, OfSeveralStandTwoInARow) {
  const std::string svg = as_svg({{.title = "one"}, {.title = "two"}, {.title = "three"}});
  for (const char* text : {R"(width="1280" height="800")", "translate(0,0)", "translate(640,0)",
                           "translate(0,400)", ">three<"}) {
    EXPECT_THAT(svg, HasSubstr(text));
  }
}

TEST(Plot, IsWrittenAndReported) {
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
