// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace independent {

struct DecodedScan {
  double receipt = 0;  ///< capture time of the packet that completes the telegram [s]
  std::uint32_t stamp_us = 0, transmission_us = 0;
  std::uint16_t scan_counter = 0;
  std::vector<double> ranges;  ///< [m]
};

struct DecodedReading {
  double receipt = 0;  ///< [s]
  std::uint32_t device_us = 0, count = 0;
};

struct DecodedCapture {
  std::map<std::string, std::vector<DecodedScan>> scans;  ///< by "address:port" of the device
  std::vector<DecodedReading> readings;
};

/// Reads a capture that this program wrote; times are counted from the file's first packet.
DecodedCapture decode_capture(const std::string& path);

}  // namespace independent
