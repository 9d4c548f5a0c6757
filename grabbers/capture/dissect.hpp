// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string_view>
#include <variant>

#include "grabbers/capture/packet.hpp"
#include "grabbers/devices/network.hpp"

namespace crisp::capture {

/// Why a packet holds nothing for us.
enum class NoIp : std::uint8_t {
  OtherProtocol,    ///< ARP and the like: nothing is lost
  UnknownLinkType,  ///< an interface that is not understood
  Damaged,          ///< headers that contradict themselves, or a wrong header checksum
};

/// The IP packet in a captured one. Link types: Ethernet with any number of VLAN tags, Linux cooked (SLL,
/// SLL2), raw IP, loopback (NULL, LOOP).
std::variant<devices::IpPacket, NoIp> dissect_ip(const Packet& packet);

/// The TCP segment or UDP datagram of an IP packet that is whole.
/// @param damaged is set where the headers contradict themselves
/// @return nothing for other protocols and damaged headers
std::optional<devices::TransportPacket> dissect_transport(const devices::IpPacket& ip, bool& damaged);

/// A name for people: "Ethernet", "link type 147".
std::string link_type_name(std::uint32_t link_type);

}  // namespace crisp::capture
