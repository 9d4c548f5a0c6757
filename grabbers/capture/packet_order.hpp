// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "grabbers/capture/capture_file.hpp"
#include "grabbers/devices/network.hpp"

namespace crisp::capture {

/// Packets of a capture are in order if none is earlier by more than this than one before it [ns]: captures
/// of several interfaces are slightly out of order.
inline constexpr std::int64_t kMaxReordering = 100'000'000;

/// Two addresses that talk to each other, the lesser first. One interface of the hub sees both directions.
using IpPair = std::pair<devices::IpAddress, devices::IpAddress>;
inline IpPair pair_of(const devices::IpPacket& packet) { return std::minmax(packet.from, packet.to); }

/// A part of a capture file whose packets are in order.
struct OrderedSegment {
  CaptureFile::Place begin = {};
  std::uint64_t end = std::numeric_limits<std::uint64_t>::max();     ///< [bytes] in the file
  std::int64_t first_ns = std::numeric_limits<std::int64_t>::min();  ///< of its packets, with the shift
  std::int64_t last_ns = std::numeric_limits<std::int64_t>::max();
  std::int64_t shift_ns = 0;  ///< what is added to the time of its packets
};

/// The order of a capture's packets by their arrival.
struct PacketOrder {
  std::vector<OrderedSegment> stretches = {OrderedSegment{}};  ///< ascending in first_ns; they may overlap
  std::map<IpPair, std::int64_t> shift_ns = {};  ///< added to the times of what these sent to each other
  std::vector<std::string> remarks = {};         ///< what is out of order, and what is made of it
};

/// Reads the times of all packets; and the packets themselves where the times go back.
///
/// Where the times go back, TCP distinguishes two cases: connections that continue there, byte for byte, show
/// that the hub's clock was set back (or its 32 bits of seconds wrapped), and time goes on; otherwise the
/// file's parts are in another order than that of their times. Where the times of each pair of addresses
/// ascend but for a constant offset, interfaces have clocks of their own, such as TAI and UTC.
///
/// @param interrupted  as ByteStream's
/// @throws Error if the file cannot be read or is no capture
PacketOrder determine_packet_order(const std::filesystem::path& path,
                                   const std::function<bool()>& interrupted = {});

}  // namespace crisp::capture
