// SPDX-License-Identifier: BSD-3-Clause
// count_scans: how many scans of lasers and encoder readings a simulated scanner sends in a second.
// count_scans HUB.pcap: how many a capture holds.
// count_scans RIG.yaml SECONDS: how many the devices of a rig send in that time.
#include <chrono>
#include <cstdlib>
#include <exception>
#include <functional>
#include <iostream>
#include <memory>
#include <thread>

#include <crisp/capture_grabber.hpp>    // crisp::pcl
#include <crisp/live_grabber.hpp>       // crisp::pcl
#include <crisp/rig_file.hpp>           // crisp::files
#include <crisp/simulator_grabber.hpp>  // crisp::pcl

namespace {

/// @param wait  returns when enough was counted
void count(crisp::SourceGrabber& grabber, const std::function<void()>& wait) {
  int scans = 0;
  int readings = 0;
  grabber.registerCallback(std::function<crisp::SourceGrabber::ScanCallback>(
      [&](const std::shared_ptr<const crisp::Scan>&) { ++scans; }));
  grabber.registerCallback(
      std::function<crisp::SourceGrabber::ReadingCallback>([&](const crisp::PlateReading&) { ++readings; }));
  grabber.start();
  wait();
  grabber.stop();
  if (grabber.error()) std::rethrow_exception(grabber.error());
  std::cout << scans << " scans, " << readings << " readings\n";
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc == 1) {
    crisp::SimulatorGrabber grabber({.duration = 1});
    count(grabber, [&] { grabber.wait(); });
  } else if (argc == 2) {
    crisp::CaptureGrabber grabber(argv[1]);
    count(grabber, [&] { grabber.wait(); });
  } else if (argc == 3) {
    crisp::LiveGrabber grabber(crisp::read_rig(argv[1]));
    count(grabber, [&] { std::this_thread::sleep_for(std::chrono::duration<double>(std::atof(argv[2]))); });
  } else {
    return 2;
  }
  return 0;
} catch (const std::exception& error) {
  std::cerr << error.what() << "\n";
  return 1;
}
