// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "grabbers/wire/scan_data.hpp"

namespace crisp::emulate {

/// The clock and counters of an emulated laser: those of the scans that it is given, but running fast by a
/// skew, and beginning at zero when the laser starts again.
class EmulatedClock {
 public:
  explicit EmulatedClock(double skew = 0) : skew_(skew) {}

  /// The laser starts again, as long before the next scan as that needs from its index to its transmission.
  void restart() { restarted_ = true; }

  /// Puts the clock's times and counters in the place of a scan's; scans in the order of their transmission.
  void stamp(wire::ScanData& scan) {
    const std::uint32_t handover = scan.transmission_time_us - scan.scan_time_us;
    if (!begun_ || restarted_) begin(scan, handover);
    elapsed_us_ += static_cast<std::uint32_t>(scan.transmission_time_us - last_us_);
    last_us_ = scan.transmission_time_us;
    scan.transmission_time_us = start_us_ + faster(elapsed_us_);
    scan.scan_time_us = scan.transmission_time_us - faster(handover);
    scan.telegram_counter = static_cast<std::uint16_t>(scan.telegram_counter - first_telegram_);
    scan.scan_counter = static_cast<std::uint16_t>(scan.scan_counter - first_scan_);
  }

 private:
  void begin(const wire::ScanData& scan, std::uint32_t handover) {
    last_us_ = scan.transmission_time_us;
    elapsed_us_ = restarted_ ? handover : 0;
    start_us_ = restarted_ ? 0 : scan.transmission_time_us;
    first_telegram_ = restarted_ ? scan.telegram_counter : std::uint16_t{0};
    first_scan_ = restarted_ ? scan.scan_counter : std::uint16_t{0};
    begun_ = true;
    restarted_ = false;
  }
  std::uint32_t faster(std::uint64_t us) const {
    const auto gained = static_cast<std::int64_t>(static_cast<double>(us) * skew_);
    return static_cast<std::uint32_t>(static_cast<std::int64_t>(us) + gained);
  }

  double skew_;
  bool begun_ = false;
  bool restarted_ = false;
  std::uint32_t start_us_ = 0;    ///< what it showed when it began
  std::uint32_t last_us_ = 0;     ///< of the scans that it is given
  std::uint64_t elapsed_us_ = 0;  ///< likewise, since it began
  std::uint16_t first_telegram_ = 0, first_scan_ = 0;
};

}  // namespace crisp::emulate
