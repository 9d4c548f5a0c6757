// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace independent {

struct Endpoint {
  std::string ip;  ///< dotted IPv4 address
  int port = 0;
};

/// A packet as the hub's network interface captures it.
struct Packet {
  double time = 0;   ///< hub time since the capture's begin [s]
  std::string data;  ///< the IP packet, without a link header
};

std::string udp_packet(const Endpoint& from, const Endpoint& to, const std::string& payload);

enum TcpFlag : std::uint8_t { kFin = 1, kSyn = 2, kPush = 8, kAcknowledge = 16 };

std::string tcp_packet(const Endpoint& from, const Endpoint& to, std::uint32_t sequence,
                       std::uint32_t acknowledged, int flags, const std::string& payload);

/// Writes packets in order of time as a capture file.
///
/// @param container  pcap_us, pcap_ns, pcap_us_big, pcap_ns_big (time unit, byte order) or pcapng
/// @param link       ethernet, vlan, sll, sll2, raw or loopback
/// @param epoch      hub time of the capture's begin, in ns since 1970
void write_capture(const std::string& path, std::vector<Packet> packets, const std::string& container,
                   const std::string& link, std::int64_t epoch);

}  // namespace independent
