// SPDX-License-Identifier: BSD-3-Clause
// scans HUB.pcap: how many scans of lasers and encoder readings a capture holds.
#include <exception>
#include <functional>
#include <iostream>
#include <memory>

#include <crisp/capture_grabber.hpp>  // crisp::pcl

int main(int argc, char** argv) try {
  if (argc != 2) return 2;
  int scans = 0;
  int readings = 0;
  crisp::CaptureGrabber grabber(argv[1]);
  grabber.registerCallback(std::function<crisp::SourceGrabber::ScanCallback>(
      [&](const std::shared_ptr<const crisp::Scan>&) { ++scans; }));
  grabber.registerCallback(
      std::function<crisp::SourceGrabber::ReadingCallback>([&](const crisp::PlateReading&) { ++readings; }));
  grabber.start();
  grabber.wait();
  if (grabber.error()) std::rethrow_exception(grabber.error());
  std::cout << scans << " scans, " << readings << " readings\n";
  return 0;
} catch (const std::exception& error) {
  std::cerr << error.what() << "\n";
  return 1;
}
