// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/dissect.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "grabbers/capture/byte_order.hpp"

namespace crisp::capture {
namespace {

using devices::IpPacket;

// https://www.tcpdump.org/linktypes.html; raw IP also by the numbers that BSDs once wrote into files
enum LinkType : std::uint32_t {
  kNull = 0,
  kEthernet = 1,
  kRawBsd = 12,
  kRawOpenBsd = 14,
  kRaw = 101,
  kLoop = 108,
  kCooked = 113,
  kRawIpv4 = 228,
  kRawIpv6 = 229,
  kCooked2 = 276
};

constexpr std::uint16_t kIpv4 = 0x0800, kIpv6 = 0x86DD;
constexpr std::size_t kIpv4Header = 20, kIpv6Header = 40;

bool is_vlan(std::uint16_t type) { return type == 0x8100 || type == 0x88A8 || type == 0x9100; }

std::variant<IpPacket, NoIp> dissect_ipv4(wire::ByteView bytes, bool cut_short) {
  if (bytes.size() < kIpv4Header || bytes[0] >> 4 != 4) return NoIp::Damaged;
  const std::size_t header = std::size_t{4} * (bytes[0] & 0xF);
  if (header < kIpv4Header || header > bytes.size()) return NoIp::Damaged;
  const bool checksum_sent = network_number<std::uint16_t>(bytes, 10) != 0;
  if (checksum_sent && devices::internet_sum(bytes.first(header)) != 0xFFFF) return NoIp::Damaged;
  std::size_t total = network_number<std::uint16_t>(bytes, 2);
  if (total == 0) total = bytes.size();  // segments that the network card was to cut
  if (total < header || (total > bytes.size() && !cut_short)) return NoIp::Damaged;
  const auto there = std::min(total, bytes.size());
  const auto fragment = network_number<std::uint16_t>(bytes, 6);
  IpPacket ip{.protocol = bytes[9],
              .payload = bytes.subspan(header, there - header),
              .missing = static_cast<std::uint32_t>(total - there),
              .more_fragments = (fragment & 0x2000) != 0,
              .fragment_offset = (fragment & 0x1FFFU) * 8,
              .id = network_number<std::uint16_t>(bytes, 4)};
  for (auto* address : {&ip.from, &ip.to}) (*address)[10] = (*address)[11] = 0xFF;
  std::copy_n(bytes.begin() + 12, 4, ip.from.begin() + 12);
  std::copy_n(bytes.begin() + 16, 4, ip.to.begin() + 12);
  return ip;
}

/// Walks over IPv6's extension headers; false if they are damaged.
bool pass_extensions(IpPacket& ip) {
  constexpr std::uint8_t kHopByHop = 0, kRouting = 43, kFragment = 44, kAuthentication = 51,
                         kDestination = 60;
  while (true) {
    const auto type = ip.protocol;
    const bool options = type == kHopByHop || type == kRouting || type == kDestination;
    if (!options && type != kFragment && type != kAuthentication) return true;
    if (ip.payload.size() < 8) return false;
    std::size_t size = 8;
    if (options) size = std::size_t{8} * (ip.payload[1] + 1U);
    if (type == kAuthentication) size = std::size_t{4} * (ip.payload[1] + 2U);
    if (type == kFragment) {
      const auto field = network_number<std::uint16_t>(ip.payload, 2);
      ip.fragment_offset = field & 0xFFF8U;
      ip.more_fragments = (field & 1) != 0;
      ip.id = network_number<std::uint32_t>(ip.payload, 4);
    }
    if (size > ip.payload.size()) return false;
    ip.protocol = ip.payload[0];
    ip.payload = ip.payload.subspan(size);
    if (ip.fragment_offset > 0) return true;  // what follows is no header
  }
}

std::variant<IpPacket, NoIp> dissect_ipv6(wire::ByteView bytes, bool cut_short) {
  if (bytes.size() < kIpv6Header || bytes[0] >> 4 != 6) return NoIp::Damaged;
  std::size_t total = kIpv6Header + network_number<std::uint16_t>(bytes, 4);
  if (total == kIpv6Header) total = bytes.size();  // as above, or a jumbogram
  if (total > bytes.size() && !cut_short) return NoIp::Damaged;
  const auto there = std::min(total, bytes.size());
  IpPacket ip{.protocol = bytes[6],
              .payload = bytes.subspan(kIpv6Header, there - kIpv6Header),
              .missing = static_cast<std::uint32_t>(total - there)};
  std::copy_n(bytes.begin() + 8, 16, ip.from.begin());
  std::copy_n(bytes.begin() + 24, 16, ip.to.begin());
  if (!pass_extensions(ip)) return NoIp::Damaged;
  return ip;
}

std::variant<IpPacket, NoIp> by_version(wire::ByteView bytes, bool cut_short) {
  if (bytes.empty()) return NoIp::Damaged;
  return bytes[0] >> 4 == 6 ? dissect_ipv6(bytes, cut_short) : dissect_ipv4(bytes, cut_short);
}

/// @param type_at where the Ethernet type lies; the payload begins `header` bytes from the start
std::variant<IpPacket, NoIp> by_ethernet_type(wire::ByteView bytes, std::size_t type_at, std::size_t header,
                                              bool cut_short) {
  if (bytes.size() < header) return NoIp::Damaged;
  auto type = network_number<std::uint16_t>(bytes, type_at);
  bytes = bytes.subspan(header);
  while (is_vlan(type)) {
    if (bytes.size() < 4) return NoIp::Damaged;
    type = network_number<std::uint16_t>(bytes, 2);
    bytes = bytes.subspan(4);
  }
  if (type == kIpv4) return dissect_ipv4(bytes, cut_short);
  if (type == kIpv6) return dissect_ipv6(bytes, cut_short);
  return NoIp::OtherProtocol;
}

/// Loopback's header is the address family, a number that differs between systems: the IP version is
/// sufficient.
std::variant<IpPacket, NoIp> loopback(wire::ByteView bytes, bool cut_short) {
  if (bytes.size() < 5) return NoIp::Damaged;
  const auto version = bytes[4] >> 4;
  if (version != 4 && version != 6) return NoIp::OtherProtocol;
  return by_version(bytes.subspan(4), cut_short);
}

devices::ChecksumVerdict verify(const IpPacket& ip, std::size_t checksum_at) {
  if (ip.missing > 0) return devices::ChecksumVerdict::Unknown;
  const auto length = static_cast<std::uint32_t>(ip.payload.size());
  // The prefix of an IPv4 address in its IPv6 form sums to 0xFFFF, which is zero.
  const auto sum = devices::internet_sum(
      ip.from, devices::internet_sum(ip.to, ip.protocol + (length & 0xFFFF) + (length >> 16)));
  if (devices::internet_sum(ip.payload, sum) == 0xFFFF) return devices::ChecksumVerdict::Right;
  // A sender's network card is left with the sum of the addresses alone, as are merged segments.
  return network_number<std::uint16_t>(ip.payload, checksum_at) % 0xFFFF == sum % 0xFFFF
             ? devices::ChecksumVerdict::Unknown
             : devices::ChecksumVerdict::Wrong;
}

}  // namespace

std::variant<IpPacket, NoIp> dissect_ip(const Packet& packet) {
  const auto bytes = packet.bytes;
  const bool cut_short = packet.original_size > bytes.size();
  switch (packet.link_type) {
    case kEthernet:
      return by_ethernet_type(bytes, 12, 14, cut_short);
    case kCooked:
      return by_ethernet_type(bytes, 14, 16, cut_short);
    case kCooked2:
      return by_ethernet_type(bytes, 0, 20, cut_short);
    case kNull:
    case kLoop:
      return loopback(bytes, cut_short);
    case kRaw:
    case kRawBsd:
    case kRawOpenBsd:
    case kRawIpv4:
    case kRawIpv6:
      return by_version(bytes, cut_short);
    default:
      return NoIp::UnknownLinkType;
  }
}

std::optional<devices::TransportPacket> dissect_transport(const IpPacket& ip, bool& damaged) {
  const bool tcp = ip.protocol == static_cast<std::uint8_t>(devices::Transport::Tcp);
  const bool udp = ip.protocol == static_cast<std::uint8_t>(devices::Transport::Udp);
  if (!tcp && !udp) return {};
  const auto bytes = ip.payload;
  const std::size_t smallest = tcp ? 20 : 8;
  damaged = bytes.size() < smallest;
  if (damaged) return {};
  devices::TransportPacket packet{.missing = ip.missing};
  packet.key = {{ip.from, network_number<std::uint16_t>(bytes, 0)},
                {ip.to, network_number<std::uint16_t>(bytes, 2)},
                tcp ? devices::Transport::Tcp : devices::Transport::Udp};
  std::size_t header = smallest, end = bytes.size();
  if (tcp) {
    header = std::size_t{4} * (bytes[12] >> 4);
    packet.sequence = network_number<std::uint32_t>(bytes, 4);
    packet.fin = (bytes[13] & 1) != 0;
    packet.syn = (bytes[13] & 2) != 0;
    packet.reset = (bytes[13] & 4) != 0;
    packet.checksum = verify(ip, 16);
  } else {
    const auto length = network_number<std::uint16_t>(bytes, 4);
    if (length != 0) end = std::min<std::size_t>(end, length);
    const bool sent = network_number<std::uint16_t>(bytes, 6) != 0;
    if (sent) packet.checksum = verify(ip, 6);
  }
  damaged = header < smallest || header > end;
  if (damaged) return {};
  packet.payload = bytes.subspan(header, end - header);
  return packet;
}

std::string link_type_name(std::uint32_t link_type) {
  switch (link_type) {
    case kEthernet:
      return "Ethernet";
    case kCooked:
      return "Linux cooked";
    case kCooked2:
      return "Linux cooked v2";
    case kNull:
    case kLoop:
      return "loopback";
    case kRaw:
    case kRawBsd:
    case kRawOpenBsd:
    case kRawIpv4:
    case kRawIpv6:
      return "raw IP";
    default:
      return fmt::format("link type {}", link_type);
  }
}

}  // namespace crisp::capture
