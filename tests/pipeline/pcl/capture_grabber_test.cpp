// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <limits>

#include <crisp/capture_grabber.hpp>
#include <crisp/error.hpp>

#include "tests/grabbers/capture/scenario.hpp"
#include "tests/grabbers/capture/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::wire;

TEST(CaptureGrabber, CallsBackWithEverythingThatTheCaptureHolds) {
  const Scenario scenario;
  const MemoryFile file(pcap_file(scenario.frames()));
  CaptureGrabber grabber(file.path());
  std::vector<std::string> items;
  grabber.registerCallback(std::function<SourceGrabber::ScanCallback>(
      [&](const std::shared_ptr<const Scan>& scan) { items.push_back(describe(HubItem(scan))); }));
  grabber.registerCallback(std::function<SourceGrabber::ReadingCallback>(
      [&](const PlateReading& reading) { items.push_back(describe(HubItem(reading))); }));
  grabber.start();
  grabber.wait();
  EXPECT_EQ(items, describe(scenario.items()));
  EXPECT_EQ(grabber.statistics().devices.at(0).items, 10U);
  EXPECT_NEAR(grabber.getFramesPerSecond(), 19 / 0.183, 1e-3) << "two lasers' scans, from 5 to 188 ms";
  EXPECT_FALSE(grabber.isRunning());
}

TEST(CaptureGrabber, StopsWhilePlayingSlowly) {
  const MemoryFile file(pcap_file(Scenario().frames()));
  CaptureGrabber grabber(file.path(), default_rig(), {.speed = 1e-6});
  grabber.start();
  grabber.stop();
  EXPECT_FALSE(grabber.isRunning());
}

TEST(CaptureGrabber, ReportsFromStartThatTheFileIsNoCapture) {
  const MemoryFile file(as_bytes("no capture"));
  CaptureGrabber grabber(file.path());
  EXPECT_THROW(grabber.start(), Error);
}

TEST(CaptureGrabber, RefusesSpeedsThatAreNone) {
  for (const double speed : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(CaptureGrabber("hub.pcap", default_rig(), {.speed = speed}), Error);
  }
}

}  // namespace
}  // namespace crisp
