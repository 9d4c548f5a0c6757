// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/picture/points.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/plugins/write/picture/support.hpp"

namespace crisp {
namespace {

using namespace crisp::write;

TEST(PicturePoints, StayBelowTheirLimitAndEvenlySpaced) {
  PicturePoints points(PictureColour::laser, 100);
  for (int i = 0; i < 1000; ++i) points.add(test::picture_cloud({{static_cast<float>(i), 0, 0}}));
  EXPECT_LT(points.kept().size(), 100U);
  EXPECT_EQ(points.one_in(), 16U);
  for (std::size_t k = 0; k < points.kept().size(); ++k)
    EXPECT_EQ(points.kept()[k].x, 16.0F * static_cast<float>(k));
  EXPECT_EQ(points.kept().size(), 63U);  // 0, 16 … 992
}

TEST(PicturePoints, HaveTheTimeSinceTheFirstOneOverAllClouds) {
  PicturePoints points(PictureColour::time);
  for (int second = 0; second < 3; ++second) {
    Cloud cloud = test::picture_cloud({{0, 0, 0}});
    cloud.header.stamp = 1'700'000'000'000'000U + static_cast<std::uint64_t>(second) * 1'000'000U;
    cloud[0].time = 0.25;
    points.add(cloud);
  }
  ASSERT_EQ(points.kept().size(), 3U);
  EXPECT_NEAR(points.kept()[0].value, 0, 1e-6);
  EXPECT_NEAR(points.kept()[2].value, 2, 1e-6);
}

TEST(PicturePoints, LeaveOutPointsWithoutPlace) {
  PicturePoints points(PictureColour::laser);
  points.add(test::picture_cloud({{0, std::numeric_limits<float>::quiet_NaN(), 0}, {1, 2, 3}}));
  EXPECT_EQ(points.kept().size(), 1U);
}

}  // namespace
}  // namespace crisp
