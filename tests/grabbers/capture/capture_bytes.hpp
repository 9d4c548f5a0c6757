// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <crisp/scan.hpp>

#include "grabbers/capture/byte_order.hpp"
#include "grabbers/capture/frame_builder.hpp"
#include "grabbers/wire/scan_data.hpp"

namespace crisp {

/// One captured packet, whatever its link type.
struct Frame {
  std::int64_t time_ns = 0;
  wire::Bytes bytes;
  std::uint32_t interface = 0;      ///< in a pcapng file
  std::uint32_t original_size = 0;  ///< 0: as many as there are
};

/// Collects frames.
capture::FrameSink into(std::vector<Frame>& frames);

/// A pcap file built by hand, independently of the code under test.
struct PcapLayout {
  capture::ByteOrder order = capture::ByteOrder::Little;
  bool nanoseconds = true;
  std::uint32_t link_type = 1;
};
wire::Bytes pcap_file(const std::vector<Frame>& frames, const PcapLayout& layout = {});

/// The parts of a pcapng file.
class PcapngBuilder {
 public:
  explicit PcapngBuilder(capture::ByteOrder order) : order_(order) {}
  PcapngBuilder& section();
  /// @param resolution if_tsresol; @param offset_s if_tsoffset, 0: none
  PcapngBuilder& interface(std::uint16_t link_type, std::uint8_t resolution, std::int64_t offset_s = 0);
  PcapngBuilder& packet(const Frame& frame, std::uint64_t ticks);
  PcapngBuilder& obsolete_packet(const Frame& frame, std::uint64_t ticks);
  PcapngBuilder& simple_packet(wire::ByteView bytes);
  PcapngBuilder& statistics(std::uint32_t interface, std::uint64_t dropped);
  PcapngBuilder& block(std::uint32_t type, wire::ByteView body);
  const wire::Bytes& bytes() const { return bytes_; }

 private:
  capture::ByteOrder order_;
  wire::Bytes bytes_;
};

/// Ethernet frames in another link layer.
wire::Bytes with_vlan(wire::ByteView ethernet, std::uint16_t tag_type);
wire::Bytes as_cooked(wire::ByteView ethernet);
wire::Bytes as_cooked2(wire::ByteView ethernet);
wire::Bytes as_raw_ip(wire::ByteView ethernet);
wire::Bytes as_loopback(wire::ByteView ethernet, std::uint32_t family, capture::ByteOrder order);

/// The devices of the tests: two lasers and the plate of the default rig, and the hub.
inline const Address kLaser1{"192.168.0.1", 2112}, kLaser2{"192.168.0.2", 2112}, kPlate{"192.168.0.10", 4000};
inline const Address kHub{"192.168.0.100", 50000}, kHubPlate{"192.168.0.100", 4000};
inline constexpr std::int64_t kStart = 1'700'000'000'000'000'000;
inline constexpr std::int64_t kNsPerMillisecond = 1'000'000;

/// Scan k of a laser: 50 a second, distances that identify the scan.
wire::ScanData numbered_scan(std::uint16_t k, std::size_t beams = 20);
PlateReading numbered_reading(std::uint16_t k);

}  // namespace crisp
