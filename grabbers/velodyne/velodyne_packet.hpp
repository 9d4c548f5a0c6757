// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "grabbers/wire/bytes.hpp"

namespace crisp::velodyne {

inline constexpr std::size_t kVelodyneLasers = 16;
inline constexpr std::size_t kVelodyneBlocks = 12;
inline constexpr std::size_t kVelodynePacket = 1206;              ///< [bytes] of a packet of measurements
inline constexpr std::uint32_t kVelodyneHour_us = 3'600'000'000;  ///< where a packet's time begins anew

/// One return of one laser.
struct VelodyneReturn {
  float range = 0;  ///< [m] 0: no echo
  std::uint8_t intensity = 0;
};

/// A data packet of a VLP-16 in its mode for the strongest or the last return: 24 firings of all lasers.
struct VelodynePacket {
  std::uint32_t time_us = 0;                      ///< [µs] past the hour, of the first laser's first shot
  std::array<double, kVelodyneBlocks> azimuth{};  ///< [rad] clockwise seen from above, at each block's begin
  std::array<std::array<std::array<VelodyneReturn, kVelodyneLasers>, 2>, kVelodyneBlocks>
      returns{};  ///< by block, firing, laser
};

/// [s] from a packet's time to a laser's shot: 55.296 µs from firing to firing, 2.304 µs from laser to laser
/// (VLP-16 User Manual, 63-9243).
double velodyne_shot(std::size_t block, std::size_t firing, std::size_t laser);

/// [µs] from one packet's time to a later one's, which is less than an hour after it.
std::uint32_t velodyne_passed_us(std::uint32_t from, std::uint32_t to);

/// Reads a packet. Nothing for other sizes, flags, products, modes, times beyond an hour and azimuths beyond
/// a turn.
std::optional<VelodynePacket> parse_velodyne(wire::ByteView bytes);

}  // namespace crisp::velodyne
