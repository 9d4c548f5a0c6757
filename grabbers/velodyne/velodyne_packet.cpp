// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/velodyne/velodyne_packet.hpp"

#include <numbers>

#include "grabbers/capture/byte_order.hpp"

namespace crisp::velodyne {
namespace {

constexpr std::size_t kBlockBytes = 100, kReturnBytes = 3, kHeaderBytes = 4;
constexpr std::uint16_t kFlag = 0xEEFF;
constexpr std::size_t kTimeAt = 1200, kModeAt = 1204, kProductAt = 1205;
constexpr std::uint8_t kStrongest = 0x37, kLast = 0x38, kVlp16 = 0x22;
constexpr std::uint16_t kAzimuthsATurn = 36000;
constexpr double kRangeStep = 0.002;  // [m]

template <class T>
T little(wire::ByteView bytes, std::size_t at) {
  return capture::number_at<T>(bytes, at, capture::ByteOrder::Little);
}

}  // namespace

double velodyne_shot(std::size_t block, std::size_t firing, std::size_t laser) {
  constexpr double kFiring = 55.296e-6, kLaser = 2.304e-6;  // [s]
  return static_cast<double>(2 * block + firing) * kFiring + static_cast<double>(laser) * kLaser;
}

std::uint32_t velodyne_passed_us(std::uint32_t from, std::uint32_t to) {
  return to >= from ? to - from : kVelodyneHour_us - (from - to);
}

std::optional<VelodynePacket> parse_velodyne(wire::ByteView bytes) {
  if (bytes.size() != kVelodynePacket || bytes[kProductAt] != kVlp16) return {};
  if (bytes[kModeAt] != kStrongest && bytes[kModeAt] != kLast) return {};
  VelodynePacket packet;
  packet.time_us = little<std::uint32_t>(bytes, kTimeAt);
  if (packet.time_us >= kVelodyneHour_us) return {};
  for (std::size_t b = 0; b < kVelodyneBlocks; ++b) {
    const std::size_t at = b * kBlockBytes;
    const auto azimuth = little<std::uint16_t>(bytes, at + 2);
    if (little<std::uint16_t>(bytes, at) != kFlag || azimuth >= kAzimuthsATurn) return {};
    packet.azimuth[b] = azimuth * 2 * std::numbers::pi / kAzimuthsATurn;
    for (std::size_t i = 0; i < 2 * kVelodyneLasers; ++i) {
      const std::size_t from = at + kHeaderBytes + i * kReturnBytes;
      auto& one = packet.returns[b][i / kVelodyneLasers][i % kVelodyneLasers];
      one.range = static_cast<float>(little<std::uint16_t>(bytes, from) * kRangeStep);
      one.intensity = bytes[from + 2];
    }
  }
  return packet;
}

}  // namespace crisp::velodyne
