// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/clocks/pauses.hpp"

#include <gtest/gtest.h>

namespace crisp {
namespace {

using namespace crisp::clocks;

constexpr std::int64_t kSecond = 1'000'000'000;

TEST(Pauses, EndWithTheFirstItemAfterFiveSeconds) {
  Pauses pauses;
  EXPECT_FALSE(pauses.hear(100 * kSecond)) << "nothing came before";
  EXPECT_FALSE(pauses.hear(105 * kSecond)) << "5 s are none";
  EXPECT_TRUE(pauses.end_before(110 * kSecond + 1'000));
  EXPECT_TRUE(pauses.hear(110 * kSecond + 1'000));
  EXPECT_FALSE(pauses.hear(110 * kSecond + 2'000));
  EXPECT_EQ(pauses.count(), 1U);
  EXPECT_NEAR(pauses.seconds(), 5.000'001, 1e-9);
}

TEST(Pauses, CountFromTheNewestItem) {
  Pauses pauses;
  pauses.hear(100 * kSecond);
  EXPECT_FALSE(pauses.hear(94 * kSecond)) << "an item that came late";
  EXPECT_FALSE(pauses.hear(102 * kSecond));
  EXPECT_FALSE(pauses.end_before(106 * kSecond));
}

TEST(Pauses, LieBetweenItemsAroundThem) {
  Pauses pauses;
  EXPECT_FALSE(pauses.last_is_between(0, kSecond)) << "there is none";
  pauses.hear(10 * kSecond);
  pauses.hear(20 * kSecond);
  EXPECT_TRUE(pauses.last_is_between(9 * kSecond, 21 * kSecond));
  EXPECT_TRUE(pauses.last_is_between(10 * kSecond, 20 * kSecond));
  EXPECT_FALSE(pauses.last_is_between(11 * kSecond, 21 * kSecond));
  EXPECT_FALSE(pauses.last_is_between(9 * kSecond, 19 * kSecond));
}

}  // namespace
}  // namespace crisp
