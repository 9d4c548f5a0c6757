// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/data/clock_map.hpp"

#include <gtest/gtest.h>

namespace crisp {
namespace {

ClockMap two_pieces() {
  return {.device = "laser1",
          .pieces = {{.device_begin = 10, .hub_begin = 100, .rate = 1 + 1e-6},
                     {.device_begin = 20, .hub_begin = 110 + 10e-6, .rate = 1 - 3e-6}},
          .device_end = 50};
}

TEST(ClockMap, UsesThePieceThatATimeLiesIn) {
  const auto map = two_pieces();
  EXPECT_DOUBLE_EQ(map.to_hub(15), 105 + 5e-6);
  EXPECT_DOUBLE_EQ(map.to_hub(30), 110 + 10e-6 + 10 * (1 - 3e-6));
}

TEST(ClockMap, ExtendsItsEndsAsStraightLines) {
  const auto map = two_pieces();
  EXPECT_DOUBLE_EQ(map.to_hub(0), 100 - 10 * (1 + 1e-6));
  EXPECT_DOUBLE_EQ(map.to_hub(1000), 110 + 10e-6 + 980 * (1 - 3e-6));
}

TEST(ClockMap, WeightsTheSkewOfEachPieceByItsDuration) {
  EXPECT_NEAR(two_pieces().skew_ppm(), (10 * 1.0 + 30 * -3.0) / 40, 1e-6);
}

}  // namespace
}  // namespace crisp
