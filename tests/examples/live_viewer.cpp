// SPDX-License-Identifier: BSD-3-Clause
// A PCL program on a live scanner: a viewer without a display, which prints the number of points of each
// revolution of the plate.
//
//     live_viewer RIG.yaml CALIBRATION.yaml CLOUDS
#include <condition_variable>
#include <cstdlib>
#include <iostream>
#include <mutex>

#include <crisp/calibration_file.hpp>
#include <crisp/cloud_grabber.hpp>
#include <crisp/rig_file.hpp>

namespace {

void watch(const crisp::Rig& rig, const crisp::Calibration& calibration, long requested) {
  crisp::LiveCloudGrabber grabber(rig, calibration);
  std::mutex mutex;
  std::condition_variable changed;
  long clouds = 0;
  const std::function<void(const crisp::Cloud::ConstPtr&)> show = [&](const crisp::Cloud::ConstPtr& cloud) {
    const std::lock_guard lock(mutex);
    std::cout << "cloud " << ++clouds << ": " << cloud->size() << " points" << std::endl;
    changed.notify_all();
  };
  grabber.registerCallback(show);
  grabber.start();
  std::unique_lock lock(mutex);
  changed.wait(lock, [&] { return clouds >= requested || !grabber.isRunning(); });
  lock.unlock();
  grabber.stop();
  if (grabber.error()) std::rethrow_exception(grabber.error());
}

}  // namespace

int main(int count, char** words) {
  if (count != 4) {
    std::cerr << "usage: live_viewer RIG.yaml CALIBRATION.yaml CLOUDS\n";
    return EXIT_FAILURE;
  }
  try {
    watch(crisp::read_rig(words[1]), crisp::read_calibration(words[2]), std::atol(words[3]));
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << "\n";
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
