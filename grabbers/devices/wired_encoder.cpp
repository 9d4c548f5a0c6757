// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/devices/wired_encoder.hpp"

namespace crisp::devices {

WiredEncoder::WiredEncoder(const Rig& rig, clocks::Pauses* pauses)
    : laser_(rig.plate.encoder_of.value()),
      log_(DeviceKind::Plate, rig.plate.name, rig.lasers.at(laser_).address, 0, pauses) {}

std::uint32_t WiredEncoder::continued(std::uint32_t position, EncoderWidths widths) {
  if (widths == EncoderWidths::Position32 || !count_) return position;
  return *count_ + static_cast<std::uint32_t>(static_cast<std::int16_t>(position - *count_));
}

std::optional<PlateReading> WiredEncoder::read(const Scan& scan, EncoderWidths widths) {
  if (scan.laser != laser_) return {};
  if (scan.encoders.empty()) {
    log_.lose("scans without the encoder's count");
    return {};
  }
  count_ = continued(scan.encoders.front().position, widths);
  return log_.take({.sequence = scan.telegram_counter,
                    .device_us = scan.scan_time_us,
                    .count = *count_,
                    .receipt_ns = scan.receipt_ns,
                    .numbered = scan.numbered,
                    .handover_us = static_cast<std::int32_t>(scan.transmission_time_us - scan.scan_time_us)},
                   "encoder of a laser");
}

}  // namespace crisp::devices
