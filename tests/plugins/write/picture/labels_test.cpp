// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/picture/labels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "plugins/write/picture/colours.hpp"
#include "tests/support/source_dir.hpp"

namespace crisp {
namespace {

using namespace crisp::write;

Picture black(std::uint32_t width, std::uint32_t height) {
  Picture picture{.width = width, .height = height, .rgb = {}};
  picture.rgb.resize(std::size_t{3} * width * height);
  return picture;
}

/// How many pixels of a row are white.
int white_in(const Picture& picture, std::uint32_t row) {
  int count = 0;
  for (std::uint32_t column = 0; column < picture.width; ++column) {
    count += picture.rgb[std::size_t{3} * (std::size_t{row} * picture.width + column)] == 255 ? 1 : 0;
  }
  return count;
}

/// Pixels of the scale bar of an 800 × 600 picture: the longest white row in its lower part.
int bar_length(double across) {
  Picture picture = black(800, 600);
  draw_scale_bar(picture, across);
  int longest = 0;
  for (std::uint32_t row = 560; row < 600; ++row) longest = std::max(longest, white_in(picture, row));
  return longest;
}

TEST(ScaleBar, IsARoundLengthOfAtMostAQuarter) {
  EXPECT_EQ(bar_length(12), 133);   // 2 m of 12 m
  EXPECT_EQ(bar_length(40), 200);   // 10 m of 40 m
  EXPECT_EQ(bar_length(0.5), 160);  // 100 mm of 500 mm
  EXPECT_EQ(bar_length(250), 160);  // 50 m of 250 m
}

TEST(ScaleBar, IsLeftOutOfAThumbnail) {
  Picture picture = black(60, 60);
  draw_scale_bar(picture, 10);
  EXPECT_TRUE(std::ranges::all_of(picture.rgb, [](std::uint8_t channel) { return channel == 0; }));
}

TEST(ColourScale, RunsFromTheRampsFirstColourToItsLast) {
  Picture picture = black(800, 600);
  draw_colour_scale(picture, -1.5, 20.25, "m");
  const std::uint32_t row = 600 - 16 - 2;
  std::vector<PictureRgb> colours;
  for (std::uint32_t column = 0; column < 800; ++column) {
    const std::uint8_t* at = &picture.rgb[std::size_t{3} * (row * 800 + column)];
    if (at[0] + at[1] + at[2] > 0) colours.push_back({at[0], at[1], at[2]});
  }
  ASSERT_EQ(colours.size(), 200U);
  EXPECT_EQ(colours.front(), kRamp.front());
  EXPECT_EQ(colours.back(), kRamp.back());
}

std::string list_of(const auto& colours) {
  std::string text;
  for (const PictureRgb& colour : colours) {
    text += (text.empty() ? "[" : ", [") + std::to_string(colour[0]) + ", " + std::to_string(colour[1]) +
            ", " + std::to_string(colour[2]) + "]";
  }
  return "[" + text + "]";
}

TEST(Colours, AreThoseOfTheReportsPage) {
  std::ifstream stream(source_dir() + "/plugins/report/page/colours.js");
  std::stringstream page;
  page << stream.rdbuf();
  EXPECT_NE(page.str().find("LASER_COLOURS = " + list_of(kLaserColours) + ";"), std::string::npos);
  EXPECT_NE(page.str().find("RAMP = " + list_of(kRamp) + ";"), std::string::npos);
}

}  // namespace
}  // namespace crisp
