// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string_view>

#include <crisp/scan.hpp>

#include "grabbers/wire/scan_data.hpp"

namespace crisp::wire {

/// Raw distances below this are codes (0 no echo, 2, 3 …), not millimetres.
inline constexpr std::uint16_t kFirstDistance = 16;

/// Why a decoded telegram makes no scan.
enum class ScanFailure : std::uint8_t {
  None,
  NoDistances,       ///< no channel DISTn
  ChannelsDisagree,  ///< channels of one scan with different angles or numbers of values
  BadScale,          ///< a scale factor or an offset that is no finite number
  BadAngles,         ///< angles beyond a full turn, or the same for all values
};

std::string_view to_string(ScanFailure failure);

/// [rad] The angular step that a telegram's rounded one stands for: steps that are a multiple of 1/24° but
/// for the rounding to 1/10000° (3333, 1667, 833, 417 …) mean that fraction, all others themselves.
double exact_angle_step(std::uint16_t step);

/// The scan that a telegram holds, in SI units: echoes[n − 1] from DISTn and RSSIn, codes as range 0.
/// @param data       decoded telegram
/// @param laser      index of the laser in the rig
/// @param receipt_ns [ns since the Unix epoch] hub time of the packet that completed the telegram
/// @param scan       receives the scan; its memory is used again. Half filled after a failure.
ScanFailure to_scan(const ScanData& data, std::uint16_t laser, std::int64_t receipt_ns, Scan& scan);

}  // namespace crisp::wire
