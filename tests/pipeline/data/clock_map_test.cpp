// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <type_traits>

#include <crisp/clock_map.hpp>
#include <crisp/error.hpp>

namespace crisp {
namespace {

ClockMap two_pieces() {
  return {.device = "laser1",
          .pieces = ClockPieces({.device_begin = 10, .hub_begin = 100, .rate = 1 + 1e-6},
                                {{.device_begin = 20, .hub_begin = 110 + 10e-6, .rate = 1 - 3e-6}}),
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

static_assert(!std::is_default_constructible_v<ClockMap>, "a map without pieces cannot be made");

TEST(ClockMap, KeepsItsFirstPiece) {
  ClockPieces pieces({.device_begin = 3, .hub_begin = 7});
  EXPECT_FALSE(pieces.drop_last());
  EXPECT_EQ(pieces.size(), 1u);
  pieces.append({.device_begin = 4});
  EXPECT_TRUE(pieces.drop_last());
  EXPECT_EQ(pieces.back().hub_begin, 7);
}

TEST(ClockMap, RefusesPiecesThatDoNotAscend) {
  auto map = two_pieces();
  EXPECT_THROW(map.pieces.append({.device_begin = 20}), Error);
  EXPECT_THROW(map.pieces.append({.device_begin = std::nan("")}), Error);
  EXPECT_THROW(map.pieces.replace_last({.device_begin = 10}), Error);
  EXPECT_EQ(map.pieces.size(), 2u);
  map.pieces.replace_last({.device_begin = 12, .hub_begin = 5});
  EXPECT_DOUBLE_EQ(map.to_hub(13), 6);
}

}  // namespace
}  // namespace crisp
