// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/gps_time.hpp"

#include <gtest/gtest.h>

namespace crisp {
namespace {

using namespace crisp::write;

constexpr std::uint64_t kGpsEpoch = 315'964'800'000'000;  // [µs] 1980-01-06

TEST(GpsTime, BeginsIn1980) {
  EXPECT_EQ(adjusted_gps_time(kGpsEpoch), -1e9);
  EXPECT_EQ(adjusted_gps_time(kGpsEpoch - 1), std::nullopt);
  EXPECT_EQ(adjusted_gps_time(0), std::nullopt);
}

TEST(GpsTime, LeapsWithUtc) {
  // GPS second 1167264018 is 2017-01-01 00:00:01 UTC less the 18th leap second (any GPS calendar).
  constexpr std::uint64_t kNewYear2017 = 1'483'228'800'000'000;
  EXPECT_EQ(adjusted_gps_time(kNewYear2017), 167'264'018.0);
  EXPECT_EQ(adjusted_gps_time(kNewYear2017 - 1'000'000), 167'264'016.0);
}

TEST(GpsTime, HasThirteenLeapSecondsIn2004) {
  // 2004-12-11 19:48:20 UTC: GPS week 1300, second 589713
  EXPECT_EQ(adjusted_gps_time(1'102'794'500'000'000), 1300 * 604'800.0 + 589'713 - 1e9);
}

}  // namespace
}  // namespace crisp
