// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <limits>

#include <crisp/error.hpp>
#include <crisp/simulator_grabber.hpp>

#include "grabbers/simulate/recording.hpp"
#include "grabbers/simulate/scenes.hpp"

namespace crisp {
namespace {

using namespace crisp::simulate;

Simulation short_simulation() {
  Simulation simulation{.scene = "street", .duration = 0.3, .seed = 3};
  simulation.truth.lasers[1].eta.value = 0.005;
  return simulation;
}

TEST(SimulatorGrabber, CallsBackWithTheWholeRecordingAtEachStart) {
  RecordingSettings settings;
  settings.scanner.duration = 0.3;
  settings.scanner.seed = 3;
  settings.scanner.truth.lasers[1].eta.value = 0.005;
  const auto expected = simulate_recording(settings, street());
  SimulatorGrabber grabber(short_simulation());
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
  EXPECT_EQ(grabber.getName(), "SimulatorGrabber");
}

TEST(SimulatorGrabber, StopsWhilePlayingSlowly) {
  SimulatorGrabber grabber(short_simulation(), 1e-6);
  grabber.start();
  grabber.stop();
  EXPECT_FALSE(grabber.isRunning());
}

TEST(SimulatorGrabber, RefusesWhatCannotBePlayed) {
  for (const double speed : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(SimulatorGrabber(short_simulation(), speed), Error);
  }
  Simulation nowhere = short_simulation();
  nowhere.scene = "nowhere";
  EXPECT_THROW(SimulatorGrabber{nowhere}, Error);
  Simulation too_few = short_simulation();
  too_few.truth.lasers.pop_back();
  EXPECT_THROW(SimulatorGrabber{too_few}, Error);
}

}  // namespace
}  // namespace crisp
