// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/frame_builder.hpp"

#include <fmt/format.h>
#include <tins/ethernetII.h>
#include <tins/exceptions.h>
#include <tins/ip.h>
#include <tins/ipv6.h>
#include <tins/rawpdu.h>
#include <tins/tcp.h>
#include <tins/udp.h>

#include <algorithm>
#include <array>

#include <crisp/error.hpp>

namespace crisp::capture {
namespace {

using wire::ByteView;

bool is_ipv6(const Address& address) { return address.ip.find(':') != std::string::npos; }

// Parts of a hardware address: the flag of local administration, and the frame's maker.
constexpr std::uint8_t kLocal = 0x02, kRecordedMark = 0, kSimulatedMark = 0x53;
constexpr std::size_t kTarget = 0, kSource = 6;  // where a frame has its hardware addresses

/// A locally administered hardware address that is the same for the same IP address.
Tins::HWAddress<6> hardware_address(const Address& address) {
  std::array<std::uint8_t, 6> bytes{kLocal, kRecordedMark, 0, 0, 0, 0};
  if (is_ipv6(address)) {
    const Tins::IPv6Address ip(address.ip);
    std::copy(ip.begin() + 12, ip.end(), bytes.begin() + 2);
  } else {
    const std::uint32_t ip = Tins::IPv4Address(address.ip);
    for (std::size_t i = 0; i < 4; ++i) bytes[i + 2] = static_cast<std::uint8_t>(ip >> (8 * i));
  }
  return Tins::HWAddress<6>(bytes.data());
}

void check(const Address& from, const Address& to) {
  for (const auto& address : {from, to}) {
    try {
      hardware_address(address);
    } catch (const Tins::exception_base&) {
      throw Error(fmt::format("\"{}\" is no IP address", address.ip), "write it like 192.168.0.1 or fe80::1");
    }
  }
  if (is_ipv6(from) != is_ipv6(to)) {
    throw Error(fmt::format("{} and {} cannot communicate", from.ip, to.ip), "use IPv4 or IPv6 for both");
  }
}

wire::Bytes frame(const Address& from, const Address& to, std::uint16_t id, const Tins::PDU& transport) {
  Tins::EthernetII ethernet(hardware_address(to), hardware_address(from));
  if (is_ipv6(from)) {
    Tins::IPv6 ip(to.ip, from.ip);
    ip.hop_limit(64);
    return (ethernet / ip / transport).serialize();
  }
  Tins::IP ip(to.ip, from.ip);
  ip.id(id);
  ip.ttl(64);
  ip.flags(Tins::IP::DONT_FRAGMENT);
  return (ethernet / ip / transport).serialize();
}

Tins::RawPDU raw(ByteView bytes) { return {bytes.data(), static_cast<std::uint32_t>(bytes.size())}; }

}  // namespace

FrameOrigin origin_of(ByteView frame) {
  constexpr std::size_t kIp = 14, kLastFour = 4;  // an Ethernet header's length; bytes of the IP address
  if (frame.size() < kIp + 1) return FrameOrigin::Foreign;
  const bool ipv6 = frame[kIp] >> 4U == 6;
  const std::size_t source_ip = kIp + (ipv6 ? 20 : 12), target_ip = kIp + (ipv6 ? 36 : 16);
  if (frame.size() < target_ip + kLastFour) return FrameOrigin::Foreign;
  const auto belongs = [&](std::size_t hardware, std::size_t ip, std::uint8_t mark) {
    const auto address = frame.subspan(hardware, 6);
    return address[0] == kLocal && address[1] == mark &&
           std::ranges::equal(address.subspan(2), frame.subspan(ip, kLastFour));
  };
  const auto is_marked = [&](std::uint8_t mark) {
    return belongs(kTarget, target_ip, mark) && belongs(kSource, source_ip, mark);
  };
  if (is_marked(kRecordedMark)) return FrameOrigin::Recorded;
  return is_marked(kSimulatedMark) ? FrameOrigin::Simulated : FrameOrigin::Foreign;
}

void mark_as_simulated(wire::Bytes& frame) {
  for (const std::size_t hardware : {kTarget, kSource}) frame.at(hardware + 1) = kSimulatedMark;
}

void FrameSorter::push(std::int64_t time_ns, ByteView frame) {
  held_.push(time_ns, wire::Bytes(frame.begin(), frame.end()));
  const std::int64_t limit_ns = held_.last_ns() - hold_ns_ + 1;
  while (const auto due = held_.pop(limit_ns)) sink_(due->time_ns, due->item);
}

void FrameSorter::finish() {
  while (const auto frame = held_.pop()) sink_(frame->time_ns, frame->item);
}

TcpConversation::TcpConversation(const Address& server, const Address& client, FrameSink sink,
                                 TcpSettings settings)
    : server_{server, settings.server_sequence, 0},
      client_{client, settings.client_sequence, 0},
      sink_(std::move(sink)),
      settings_(settings) {
  check(server, client);
}

void TcpConversation::segment(TcpSide from, int flags, ByteView payload, std::int64_t time_ns) {
  auto& sender = side(from);
  const auto& receiver = side(from == TcpSide::Server ? TcpSide::Client : TcpSide::Server);
  Tins::TCP tcp(receiver.address.port, sender.address.port);
  tcp.seq(sender.sequence);
  if ((flags & Tins::TCP::ACK) != 0) tcp.ack_seq(receiver.sequence);
  tcp.flags(Tins::small_uint<12>(static_cast<std::uint16_t>(flags)));
  tcp.window(8192);
  if (!payload.empty()) tcp.inner_pdu(raw(payload));
  sink_(time_ns, frame(sender.address, receiver.address, ++sender.packets, tcp));
  const bool counts_one = (flags & (Tins::TCP::SYN | Tins::TCP::FIN)) != 0;
  sender.sequence += static_cast<std::uint32_t>(payload.size()) + (counts_one ? 1 : 0);
}

void TcpConversation::open(std::int64_t time_ns) {
  segment(TcpSide::Client, Tins::TCP::SYN, {}, time_ns - 2 * settings_.ack_delay_ns);
  segment(TcpSide::Server, Tins::TCP::SYN | Tins::TCP::ACK, {}, time_ns - settings_.ack_delay_ns);
  segment(TcpSide::Client, Tins::TCP::ACK, {}, time_ns);
}

void TcpConversation::send(TcpSide from, ByteView bytes, std::int64_t completed_ns) {
  while (!bytes.empty()) {
    const auto part = bytes.first(std::min(bytes.size(), settings_.largest_segment));
    bytes = bytes.subspan(part.size());
    const auto before = static_cast<std::int64_t>(settings_.ns_per_byte * static_cast<double>(bytes.size()));
    segment(from, Tins::TCP::ACK | (bytes.empty() ? Tins::TCP::PSH : 0), part, completed_ns - before);
  }
  segment(from == TcpSide::Server ? TcpSide::Client : TcpSide::Server, Tins::TCP::ACK, {},
          completed_ns + settings_.ack_delay_ns);
}

void TcpConversation::close(std::int64_t time_ns) {
  segment(TcpSide::Client, Tins::TCP::FIN | Tins::TCP::ACK, {}, time_ns);
  segment(TcpSide::Server, Tins::TCP::FIN | Tins::TCP::ACK, {}, time_ns + settings_.ack_delay_ns);
  segment(TcpSide::Client, Tins::TCP::ACK, {}, time_ns + 2 * settings_.ack_delay_ns);
}

DatagramSender::DatagramSender(Address from, Address to, FrameSink sink)
    : from_(std::move(from)), to_(std::move(to)), sink_(std::move(sink)) {
  check(from_, to_);
}

void DatagramSender::send(ByteView bytes, std::int64_t time_ns) {
  Tins::UDP udp(to_.port, from_.port);
  udp.inner_pdu(raw(bytes));
  sink_(time_ns, frame(from_, to_, ++packets_, udp));
}

}  // namespace crisp::capture
