// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/data/recordings.hpp"

#include <gtest/gtest.h>

namespace crisp {
namespace {

using namespace crisp::data;

/// Readings every 0.1 s from each begin on, for a second.
PlateTrajectory plate_from(std::initializer_list<double> begins, std::vector<double> new_zeros = {}) {
  std::vector<double> times;
  for (const double begin : begins) {
    for (int k = 0; k <= 10; ++k) times.push_back(begin + 0.1 * k);
  }
  return {0, times, times, 0.2, std::move(new_zeros)};
}

TEST(Recordings, OnesAreDividedByPauses) {
  const auto all = recordings_of(plate_from({0, 4, 20, 100}));
  ASSERT_EQ(all.size(), 3U) << "three seconds of silence are no pause";
  EXPECT_EQ(all[0].begin, 0);
  EXPECT_EQ(all[0].end, 5);
  EXPECT_EQ(all[1].begin, 20);
  EXPECT_EQ(all[2].end, 101);
  EXPECT_TRUE(recordings_of({}).empty());
}

TEST(Recordings, TimesInAPauseBelongToTheNearerOne) {
  const RecordingNumbers number(plate_from({0, 20}));
  EXPECT_EQ(number.count(), 2U);
  EXPECT_EQ(number.of(-1), 0U);
  EXPECT_EQ(number.of(10), 0U);
  EXPECT_EQ(number.of(11), 1U);
  EXPECT_EQ(number.of(500), 1U);
}

TEST(Recordings, NumbersGrowWithThePiecesOfATrajectory) {
  RecordingNumbers number;
  EXPECT_EQ(number.of(50), 0U);
  EXPECT_FALSE(number.has_readings());
  number.add(plate_from({0}));
  number.add(plate_from({4}));
  number.add(plate_from({20, 40}));
  EXPECT_TRUE(number.has_readings());
  const RecordingNumbers at_once(plate_from({0, 4, 20, 40}));
  EXPECT_EQ(number.count(), 3U);
  for (const double time : {0.0, 12.4, 12.6, 30.4, 30.6, 90.0}) EXPECT_EQ(number.of(time), at_once.of(time));
}

TEST(Recordings, AreDividedBySilencesOfMoreThanFiveSeconds) {
  RecordingNumbers number;
  number.add_silence(1, 6);
  EXPECT_EQ(number.count(), 1U);
  number.add_silence(10, 16);
  EXPECT_EQ(number.of(12.9), 0U);
  EXPECT_EQ(number.of(13.1), 1U);
}

TEST(Recordings, KnowWhichZeroTheirAnglesCountFrom) {
  const auto all = recordings_of(plate_from({0, 20, 40, 60}, {20, 60}));
  ASSERT_EQ(all.size(), 4U);
  EXPECT_EQ(all[0].zero, 0U);
  EXPECT_EQ(all[1].zero, 1U);
  EXPECT_EQ(all[2].zero, 1U);
  EXPECT_EQ(all[3].zero, 2U);
}

}  // namespace
}  // namespace crisp
