// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/data/mirror_angle.hpp"

#include <gtest/gtest.h>

namespace crisp {
namespace {

using namespace crisp::data;

TEST(MirrorAngle, IsTheRemainderOfATurnToTheLastBit) {
  for (double angle = -25; angle < 25; angle += 0.0137) {
    const double expected =
        std::abs(angle) < std::numbers::pi ? angle : std::remainder(angle, 2 * std::numbers::pi);
    EXPECT_EQ(wrapped_mirror_angle(angle), expected) << angle;
  }
}

TEST(MirrorAngle, StaysAtHalfATurnButForRounding) {
  const double half = std::numbers::pi + 1e-9;
  EXPECT_EQ(wrapped_mirror_angle(half), half);
  EXPECT_EQ(wrapped_mirror_angle(-half), -half);
}

}  // namespace
}  // namespace crisp
