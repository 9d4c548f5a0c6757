// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/picture/painter.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "plugins/write/picture/colours.hpp"
#include "tests/plugins/write/picture/support.hpp"

namespace crisp {
namespace {

using namespace crisp::write;

using Rgb = std::array<int, 3>;

/// Ten by ten pixels of 1 m.
PictureSettings chessboard() {
  return {.across = 10, .centre = std::array{0.0, 0.0}, .width = 10, .height = 10};
}

Picture painted(const Cloud& cloud, const PictureSettings& settings) {
  PicturePoints points(settings.colour);
  points.add(cloud);
  return paint(points, settings);
}

Rgb colour_at(const Picture& picture, std::size_t row, std::size_t column) {
  const std::uint8_t* at = &picture.rgb[3 * (row * picture.width + column)];
  return {at[0], at[1], at[2]};
}

/// Rows and columns of the pixels that are not black.
std::vector<std::pair<int, int>> lit(const Picture& picture) {
  std::vector<std::pair<int, int>> found;
  for (std::size_t i = 0; i < picture.rgb.size(); i += 3) {
    const int pixel = static_cast<int>(i / 3);
    if (picture.rgb[i] + picture.rgb[i + 1] + picture.rgb[i + 2] > 0)
      found.emplace_back(pixel / 10, pixel % 10);
  }
  return found;
}

using Pixels = std::vector<std::pair<int, int>>;

TEST(Painter, CountsThePointsInThePicture) {
  const Picture picture = painted(test::picture_cloud({{3.5F, 4.5F, 0}, {100, 0, 0}}), chessboard());
  EXPECT_EQ(picture.drawn, 1U);
  EXPECT_EQ(lit(picture), (Pixels{{0, 8}}));
}

TEST(Painter, GivesEachLaserItsColourAtFourPointsInAPixel) {
  Cloud cloud;
  for (std::uint16_t laser = 0; laser < 4; ++laser) {
    for (int k = 0; k < 4; ++k)
      cloud += test::picture_cloud({{static_cast<float>(laser) + 0.5F, 0.5F, 0}}, laser);
  }
  const Picture picture = painted(cloud, chessboard());
  for (std::size_t laser = 0; laser < 4; ++laser) {
    const auto& expected = kLaserColours[laser];
    EXPECT_THAT(colour_at(picture, 4, 5 + laser),
                testing::ElementsAre(expected[0], expected[1], expected[2]));
  }
}

TEST(Painter, AddsTheLightOfLasersThatAgree) {
  Cloud cloud;
  for (int k = 0; k < 4; ++k) {
    cloud += test::picture_cloud({{0.5F, 0.5F, 0}}, 0);
    cloud += test::picture_cloud({{0.5F, 0.5F, 0}}, 1);
  }
  EXPECT_THAT(colour_at(painted(cloud, chessboard()), 4, 5), testing::ElementsAre(255, 255, 233));
}

TEST(Painter, ShowsTheMeanValueOfAPixel) {
  auto settings = chessboard();
  settings.colour = PictureColour::height;
  Cloud cloud;
  for (int k = 0; k < 4; ++k) {
    cloud += test::picture_cloud({{-4.5F, 0.5F, 0}, {4.5F, 0.5F, 2}, {0.5F, 0.5F, 0}, {0.5F, 0.5F, 2}});
  }
  const Picture picture = painted(cloud, settings);
  EXPECT_THAT(colour_at(picture, 4, 0), testing::ElementsAre(68, 1, 84));     // the ramp's first
  EXPECT_THAT(colour_at(picture, 4, 5), testing::ElementsAre(33, 144, 141));  // its middle
  EXPECT_THAT(colour_at(picture, 4, 9), testing::ElementsAre(253, 231, 37));  // its last
}

TEST(Painter, LeavesOutRemissionsThatAreNotANumber) {
  auto settings = chessboard();
  settings.colour = PictureColour::remission;
  Cloud cloud = test::picture_cloud({{0.5F, 0.5F, 0}, {1.5F, 0.5F, 0}});
  cloud[0].intensity = std::numeric_limits<float>::quiet_NaN();
  cloud[1].intensity = 100;
  EXPECT_EQ(lit(painted(cloud, settings)), (Pixels{{4, 6}}));
}

}  // namespace
}  // namespace crisp
