// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <condition_variable>

#include <crisp/live_grabber.hpp>

#include "grabbers/emulate/emulator.hpp"
#include "grabbers/simulate/recording.hpp"
#include "grabbers/simulate/scenes.hpp"

namespace crisp {
namespace {

using namespace crisp::emulate;
using namespace crisp::simulate;

TEST(LiveGrabber, CallsBackWithEachScanOfAnEmulatedRigAndStops) {
  RecordingSettings settings;
  settings.scanner.duration = 0.2;
  const auto recorded = simulate_recording(settings, office());
  Rig rig = default_rig();
  for (RigLaser& laser : rig.lasers) laser.address = {"127.0.0.1", 0};
  rig.plate.address = {"127.0.0.1", 0};
  Emulator emulator(rig, {.speed = 0});

  LiveGrabber grabber(emulator.rig(), {.plate = false});
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<std::uint32_t> times;
  grabber.registerCallback(
      std::function<SourceGrabber::ScanCallback>([&](const std::shared_ptr<const Scan>& scan) {
        const std::lock_guard lock(mutex);
        if (scan->laser == 1) times.push_back(scan->scan_time_us);
        changed.notify_all();
      }));
  grabber.start();
  EXPECT_TRUE(grabber.isRunning());
  std::vector<std::uint32_t> expected;
  for (const Scan& scan : recorded.scans) {
    emulator.send(std::make_shared<const Scan>(scan), [] { return false; });
    if (scan.laser == 1) expected.push_back(scan.scan_time_us);
  }
  std::unique_lock lock(mutex);
  EXPECT_TRUE(
      changed.wait_for(lock, std::chrono::seconds(60), [&] { return times.size() == expected.size(); }));
  lock.unlock();
  grabber.stop();
  EXPECT_FALSE(grabber.isRunning());
  EXPECT_FALSE(grabber.error());
  EXPECT_EQ(times, expected);
}

}  // namespace
}  // namespace crisp
