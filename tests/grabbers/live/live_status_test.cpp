// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/live/live_status.hpp"

#include <gmock/gmock.h>

namespace crisp {
namespace {

using namespace crisp::live;
using testing::ElementsAre;
using testing::IsEmpty;

CaptureStatistics received(std::uint64_t scans) {
  CaptureStatistics statistics;
  statistics.devices.push_back({.name = "laser1", .items = scans});
  return statistics;
}

TEST(LiveStatus, ReportsRatesLossesAndTheLatencyOfTheSlowest) {
  LiveStatus status;
  status.report(received(100), 10, 0, "0 s");
  for (int i = 0; i < 200; ++i) status.passed(i < 197 ? 1e-4 : 3e-3);
  CaptureStatistics statistics = received(125);
  statistics.devices[0].losses.add(kTelegramsNeverCame, 2);
  statistics.losses.add("items dropped because the pipeline was too slow", 3);
  const StageStatus reported = status.report(statistics, 10.5, 7, "1 s");
  EXPECT_EQ(reported.line, "1 s, laser1 50.0 Hz, lost 5, queue 7, latency 3.0 ms");
}

TEST(LiveStatus, ReportsEventsOnceAndContinuingLossesEveryTenSeconds) {
  const std::string failed = "connections that failed: no scan came";
  LiveStatus status;
  CaptureStatistics statistics = received(1);
  EXPECT_THAT(status.report(statistics, 0, 0, "").events, IsEmpty());
  statistics.devices[0].notes.add(failed);
  EXPECT_THAT(status.report(statistics, 1, 0, "").events, ElementsAre("laser1: " + failed + " (1)"));
  EXPECT_THAT(status.report(statistics, 2, 0, "").events, IsEmpty()) << "nothing more happened";
  statistics.devices[0].notes.add(failed, 2);
  statistics.devices[0].losses.add(kTelegramsNeverCame, 65);
  EXPECT_THAT(status.report(statistics, 3, 0, "").events,
              ElementsAre("laser1: " + std::string(kTelegramsNeverCame) + " (65)"));
  EXPECT_THAT(status.report(statistics, 11, 0, "").events, ElementsAre("laser1: " + failed + " (2)"));
}

}  // namespace
}  // namespace crisp
