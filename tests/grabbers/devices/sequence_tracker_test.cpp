// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/devices/sequence_tracker.hpp"

#include <gtest/gtest.h>

#include "grabbers/devices/running_median.hpp"

namespace crisp {
namespace {

using namespace crisp::devices;

using Verdict = SequenceTracker::Verdict;

constexpr std::int64_t kInterval = 2'000'000;  // 500 a second

/// Sends the counter of item k at its time.
Verdict send(SequenceTracker& tracker, std::int64_t k) {
  return tracker.take(static_cast<std::uint16_t>(k), static_cast<std::uint32_t>(k), k * kInterval);
}

TEST(SequenceTracker, LosesNothingAcrossManyWraps) {
  SequenceTracker tracker;
  for (std::int64_t k = 65000; k < 300'000; ++k)
    ASSERT_EQ(send(tracker, k), k == 65000 ? Verdict::First : Verdict::Next);
  EXPECT_EQ(tracker.lost(), 0U);
}

TEST(SequenceTracker, CountsWhatIsMissing) {
  SequenceTracker tracker;
  for (std::int64_t k = 0; k < 1000; ++k) {
    if (k < 100 || k % 10 != 0) send(tracker, k);
  }
  EXPECT_EQ(tracker.lost(), 90U);
}

TEST(SequenceTracker, CountsASilenceOfManyWrapsByItsTime) {
  SequenceTracker tracker;
  for (std::int64_t k = 0; k < 1000; ++k) send(tracker, k);
  send(tracker, 1000 + 300'000);
  EXPECT_EQ(tracker.lost(), 300'000U);
}

TEST(SequenceTracker, TakesABurstBehindAPauseForNoHigherRate) {
  SequenceTracker tracker;
  std::int64_t now = 0;
  std::uint16_t counter = 0;
  const auto come = [&](int items, std::int64_t interval_ns) {
    for (int i = 0; i < items; ++i, ++counter) tracker.take(counter, counter, now += interval_ns);
  };
  come(5000, 2'000'000);
  now += 800'000'000;  // the machine is busy; what came meanwhile is handed over all at once
  come(400, 10'000);
  now += 800'000'000;
  come(400, 10'000);
  EXPECT_EQ(tracker.lost(), 0U);
}

TEST(SequenceTracker, DistinguishesLateItemsFromRepeatedOnes) {
  SequenceTracker tracker;
  for (const std::int64_t k : {0, 1, 2, 5, 6}) send(tracker, k);
  EXPECT_EQ(tracker.lost(), 2U);
  EXPECT_EQ(send(tracker, 5), Verdict::Duplicate);
  EXPECT_EQ(send(tracker, 6), Verdict::Duplicate);
  EXPECT_EQ(send(tracker, 3), Verdict::Late);
  EXPECT_EQ(send(tracker, 3), Verdict::Duplicate);
  EXPECT_EQ(tracker.lost(), 1U);
  EXPECT_EQ(send(tracker, 7), Verdict::Next);
}

TEST(SequenceTracker, TakesACounterThatStandsForNoRepetition) {
  SequenceTracker tracker;
  tracker.take(7, 100, 0);
  EXPECT_EQ(tracker.take(7, 200, kInterval), Verdict::Next);
  EXPECT_EQ(tracker.take(7, 300, 2 * kInterval), Verdict::Next);
  EXPECT_EQ(tracker.lost(), 0U);
}

TEST(SequenceTracker, BeginsAnewOnRequest) {
  SequenceTracker tracker;
  for (std::int64_t k = 0; k < 100; ++k) send(tracker, k);
  tracker.restart();
  EXPECT_EQ(tracker.take(40'000, 1, 1'000'000'000), Verdict::First);
  EXPECT_EQ(tracker.lost(), 0U);
}

TEST(RunningMedian, IsExactForFewValuesAndCloseForMany) {
  RunningMedian median;
  EXPECT_FALSE(median.value());
  for (int i = 0; i < 101; ++i) median.add((i * 37) % 101);
  EXPECT_EQ(median.value(), 50);
  RunningMedian many;
  for (int i = 0; i < 1'000'000; ++i) many.add((i * 7919LL) % 1'000'003);
  EXPECT_NEAR(*many.value(), 500'000, 30'000) << "of at least 2048 values: three standard errors";
}

}  // namespace
}  // namespace crisp
