// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "grabbers/wire/cola_encoding.hpp"

namespace crisp::wire {

/// Scan settings of a laser, in the device's units: the parameters of `mLMPsetscancfg` and `LMPscancfg`.
struct ScanSettings {
  std::uint32_t frequency = 5000;   ///< [1/100 Hz]
  std::uint16_t sectors = 1;        ///< of other scans than these nothing is known here
  std::uint32_t resolution = 5000;  ///< [1/10000°]
  std::int32_t first = -450'000;    ///< [1/10000°]
  std::int32_t last = 2'250'000;    ///< [1/10000°]
  bool operator==(const ScanSettings&) const = default;
};

std::vector<ColaValue> to_values(const ScanSettings& settings);

/// The settings in a telegram's parameters, behind the status byte where there is one; nothing if they are
/// not there. @param with_status  as in the answer to `mLMPsetscancfg`
std::optional<ScanSettings> scan_settings(const ColaTelegram& telegram, bool with_status);

/// The part of a scan that is sent: the parameters of `LMPoutputRange`.
struct OutputRange {
  std::uint32_t resolution = 5000;  ///< [1/10000°]
  std::int32_t first = -450'000;    ///< [1/10000°]
  std::int32_t last = 2'250'000;    ///< [1/10000°]
  bool operator==(const OutputRange&) const = default;
};

std::vector<ColaValue> to_values(const OutputRange& range);
std::optional<OutputRange> output_range(const ColaTelegram& telegram);

/// Sent content of a scan: the parameters of `LMDscandatacfg`.
struct ScanContent {
  std::uint16_t channels = 1;  ///< a bit each
  bool remission = false;
  bool wide = false;  ///< remissions in 16 bits instead of 8
  std::uint8_t unit = 0;
  std::uint16_t encoders = 0;  ///< a bit each
  bool position = false, name = false, comment = false, time = false;
  std::uint16_t interval = 1;  ///< every so many scans
  bool operator==(const ScanContent&) const = default;
};

std::vector<ColaValue> to_values(const ScanContent& content);
std::optional<ScanContent> scan_content(const ColaTelegram& telegram);

}  // namespace crisp::wire
