// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <tuple>

#include <crisp/rig.hpp>

#include "grabbers/wire/bytes.hpp"

namespace crisp::devices {

/// An IPv6 address, or an IPv4 one in its IPv6 form (::ffff:a.b.c.d).
using IpAddress = std::array<std::uint8_t, 16>;

/// Nothing if the text is no address.
std::optional<IpAddress> parse_ip(const std::string& text);
std::string to_string(const IpAddress& ip);

/// One end of a conversation.
struct Endpoint {
  IpAddress ip{};
  std::uint16_t port = 0;
  bool operator==(const Endpoint&) const = default;
  bool operator<(const Endpoint& other) const { return std::tie(ip, port) < std::tie(other.ip, other.port); }
};

/// Inverse of to_string(ip) with the port.
Address to_address(const Endpoint& endpoint);

enum class Transport : std::uint8_t { Tcp = 6, Udp = 17 };

/// Source, destination and protocol of a flow.
struct FlowKey {
  Endpoint from, to;
  Transport transport = Transport::Tcp;
  bool operator==(const FlowKey&) const = default;
  bool operator<(const FlowKey& other) const {
    return std::tie(from, to, transport) < std::tie(other.from, other.to, other.transport);
  }
};

/// RFC 1071's sum over 16-bit words, not yet inverted. @param sum of what came before
std::uint32_t internet_sum(wire::ByteView bytes, std::uint32_t sum = 0);

/// Result of checking a transport header's checksum.
enum class ChecksumVerdict : std::uint8_t {
  Right,
  Unknown,  ///< none was sent, not all bytes are there, or the network card was to fill it in
  Wrong,
};

/// An IP packet, or the fragment of one.
struct IpPacket {
  IpAddress from{}, to{};
  std::uint8_t protocol = 0;
  wire::ByteView payload;     ///< behind the IP headers
  std::uint32_t missing = 0;  ///< [bytes] of the payload that the capture cut off
  bool more_fragments = false;
  std::uint32_t fragment_offset = 0;  ///< [bytes]
  std::uint32_t id = 0;
  bool is_fragment() const { return more_fragments || fragment_offset > 0; }
};

/// One TCP segment or UDP datagram.
struct TransportPacket {
  FlowKey key;
  std::uint32_t sequence = 0;                    ///< TCP
  bool syn = false, fin = false, reset = false;  ///< TCP
  wire::ByteView payload;
  std::uint32_t missing = 0;  ///< [bytes] of the payload that the capture cut off
  ChecksumVerdict checksum = ChecksumVerdict::Unknown;
};

}  // namespace crisp::devices

template <>
struct std::hash<crisp::devices::FlowKey> {
  std::size_t operator()(const crisp::devices::FlowKey& key) const noexcept;
};
