// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/picture/projection.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace crisp {
namespace {

using namespace crisp::write;

using Pixel = std::array<std::uint32_t, 2>;

/// Ten by ten pixels of 1 m.
PictureSettings ten_metres(PictureView view) {
  return {.view = view, .across = 10, .centre = std::array{0.0, 0.0}, .width = 10, .height = 10};
}

TEST(Projection, ShowsXToTheRightAndYUpwardsFromTheTop) {
  const PictureProjection projection(ten_metres(PictureView::top), {});
  EXPECT_EQ(projection.pixel({.x = 3.5F, .y = 4.5F}), (Pixel{8, 0}));
}

TEST(Projection, ShowsZUpwardsFromTheFrontAndTheSide) {
  const PicturePoint point{.x = -4.5F, .y = 2.5F, .z = 1.5F};
  EXPECT_EQ(PictureProjection(ten_metres(PictureView::front), {}).pixel(point), (Pixel{0, 3}));
  EXPECT_EQ(PictureProjection(ten_metres(PictureView::side), {}).pixel(point), (Pixel{7, 3}));
}

TEST(Projection, LeavesOutWhatIsTooDeep) {
  for (const PictureView view :
       {PictureView::top, PictureView::front, PictureView::side, PictureView::perspective}) {
    auto settings = ten_metres(view);
    settings.depth = {1, 2};
    const PictureProjection projection(settings, {});
    EXPECT_FALSE(projection.pixel({.x = 0.5F, .y = 0.5F, .z = 0.5F}));
    EXPECT_TRUE(projection.pixel({.x = 1.5F, .y = 1.5F, .z = 1.5F}));
    EXPECT_FALSE(projection.pixel({.x = 2.5F, .y = 2.5F, .z = 2.5F}));
  }
}

TEST(Projection, OfPerspectiveShowsTheNearLargerThanTheFar) {
  auto settings = ten_metres(PictureView::perspective);
  settings.azimuth = -std::numbers::pi / 2;  // the eye is on −y and sees x to the right
  settings.elevation = 0;
  settings.width = settings.height = 1000;
  const std::vector<PicturePoint> middle{{.x = 0, .y = 0, .z = 0}};
  const PictureProjection projection(settings, middle);
  const auto column = [&](float x, float y) {
    return static_cast<double>((*projection.pixel({.x = x, .y = y}))[0]) - 500;
  };
  EXPECT_NEAR(column(1, 0), 100, 1);
  // The width of 10 m is seen under 0.9 rad, hence from 5 m / tan 0.45 = 10.35 m.
  const double eye = 5 / std::tan(0.45);
  EXPECT_NEAR(column(1, -4), 100 * eye / (eye - 4), 1);
  EXPECT_NEAR(column(1, 20), 100 * eye / (eye + 20), 1);
  EXPECT_FALSE(projection.pixel({.x = 0, .y = -11})) << "behind the eye";
}

TEST(Projection, FitsTheViewToThePointsAndNotToOutliers) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<float> x(20, 60), y(-3, 3);
  std::vector<PicturePoint> points;
  for (int i = 0; i < 10000; ++i) points.push_back({.x = x(random), .y = y(random)});
  for (int i = 0; i < 50; ++i) points.push_back({.x = 1e4F, .y = -1e4F});
  const PictureProjection projection({.width = 800, .height = 600}, points);
  EXPECT_EQ(projection.across(), 50);  // 98 % of 40 m and a margin are 41.2 m
  EXPECT_THAT(projection.centre(), testing::ElementsAre(40, 0));
  int inside = 0;
  for (const PicturePoint& point : points) inside += projection.pixel(point) ? 1 : 0;
  EXPECT_EQ(inside, 10000);
}

TEST(Projection, OfOnePointHasAWidth) {
  const PictureProjection projection({}, {{.x = 3, .y = 4}});
  EXPECT_GT(projection.across(), 0);
  EXPECT_TRUE(projection.pixel({.x = 3, .y = 4}));
}

TEST(RoundAbove, IsTheNextRoundNumber) {
  EXPECT_DOUBLE_EQ(round_above(1), 1);
  EXPECT_DOUBLE_EQ(round_above(11.3), 15);
  EXPECT_DOUBLE_EQ(round_above(0.081), 0.1);
  EXPECT_DOUBLE_EQ(round_above(61), 80);
}

}  // namespace
}  // namespace crisp
