// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include <crisp/rig.hpp>

#include "grabbers/devices/device_log.hpp"

namespace crisp::devices {

/// The plate's encoder where it is wired to a laser, whose telegrams carry its count: a reading for each of
/// that laser's scans, of the moment of the scan's stamp, on the laser's clock.
class WiredEncoder {
 public:
  /// @param rig     with a plate of `encoder_of`
  /// @param pauses  as of DeviceLog
  explicit WiredEncoder(const Rig& rig, clocks::Pauses* pauses = nullptr);

  /// The reading in a scan; nothing for scans of other lasers, and those without an encoder, which are
  /// counted.
  /// @param widths  of the telegrams: a count of 16 bits is continued across its wraps
  std::optional<PlateReading> read(const Scan& scan, EncoderWidths widths);

  DeviceStatistics statistics() const { return log_.statistics(); }

 private:
  std::uint32_t continued(std::uint32_t position, EncoderWidths widths);

  std::uint16_t laser_;
  DeviceLog log_;
  std::optional<std::uint32_t> count_;
};

}  // namespace crisp::devices
