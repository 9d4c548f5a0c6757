// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/scans/plot.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace crisp {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(Plot, DrawsItsSeriesWithinItsFrameAndNamesThem) {
  const std::string svg = as_svg({.title = "a < b",
                                  .x_label = "x [m]",
                                  .y_label = "y [mm]",
                                  .series = {{.name = "first", .x = {0, 1, 2}, .y = {1, std::nan(""), 3}},
                                             {.name = "dots", .x = {1}, .y = {2}, .joined = false}}});
  EXPECT_THAT(svg, HasSubstr("a &lt; b"));
  for (const char* text : {"x [m]", "y [mm]", ">first<", ">dots<", "<circle", "</svg>"})
    EXPECT_THAT(svg, HasSubstr(text));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(Plot, OfNothingIsAnEmptyFrame) {
  const std::string svg = as_svg({});
  EXPECT_THAT(svg, HasSubstr("</svg>"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, Not(HasSubstr("inf")));
}

}  // namespace
}  // namespace crisp
