// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/pcl/simulator_grabber.hpp"

#include <gtest/gtest.h>

#include <limits>

#include <crisp/error.hpp>

#include "grabbers/simulate/recording.hpp"
#include "grabbers/simulate/scenes.hpp"

namespace crisp {
namespace {

RecordingSettings short_settings() {
  RecordingSettings settings;
  settings.scanner.duration = 0.3;
  settings.scanner.truth.lasers[1].eta.value = 0.005;
  return settings;
}

TEST(SimulatorGrabber, CallsBackWithTheWholeRecordingAtEachStart) {
  const auto expected = simulate_recording(short_settings(), office());
  SimulatorGrabber grabber(short_settings(), office());
  std::vector<Scan> scans;
  std::vector<PlateReading> readings;
  grabber.registerCallback(std::function<SourceGrabber::ScanCallback>(
      [&](const std::shared_ptr<const Scan>& scan) { scans.push_back(*scan); }));
  grabber.registerCallback(std::function<SourceGrabber::ReadingCallback>(
      [&](const PlateReading& reading) { readings.push_back(reading); }));
  for (int run = 0; run < 2; ++run) {
    scans.clear();
    readings.clear();
    grabber.start();
    grabber.wait();
    EXPECT_FALSE(grabber.error());
    ASSERT_EQ(scans.size(), expected.scans.size());
    ASSERT_EQ(readings.size(), expected.readings.size());
    EXPECT_EQ(scans.back().receipt_ns, expected.scans.back().receipt_ns);
    EXPECT_EQ(scans.back().echoes[0].ranges, expected.scans.back().echoes[0].ranges);
    EXPECT_EQ(readings.back().count, expected.readings.back().count);
  }
  EXPECT_EQ(grabber.truth().calibration.lasers[1].eta.value, 0.005);
  EXPECT_EQ(grabber.getName(), "SimulatorGrabber");
}

TEST(SimulatorGrabber, StopsWhilePlayingSlowly) {
  SimulatorGrabber grabber(short_settings(), office(), 1e-6);
  grabber.start();
  grabber.stop();
  EXPECT_FALSE(grabber.isRunning());
}

TEST(SimulatorGrabber, RefusesWhatCannotBePlayed) {
  for (const double speed : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(SimulatorGrabber(short_settings(), office(), speed), Error);
  }
  RecordingSettings settings = short_settings();
  settings.scanner.range.sigma = -1;
  EXPECT_THROW(SimulatorGrabber(settings, office()), Error);
}

}  // namespace
}  // namespace crisp
