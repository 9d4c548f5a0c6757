// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>

#include <crisp/rig.hpp>

#include "grabbers/capture/reorder_buffer.hpp"
#include "grabbers/wire/bytes.hpp"

namespace crisp::capture {

/// Receives one Ethernet frame with its capture time [ns since the Unix epoch].
using FrameSink = std::function<void(std::int64_t, wire::ByteView)>;

/// Puts frames in the order of their times: holds each until a frame that is `hold_ns` younger has come.
/// Frames of equal times keep their order.
class FrameSorter {
 public:
  /// @param hold_ns  > 0
  FrameSorter(FrameSink sink, std::int64_t hold_ns) : sink_(std::move(sink)), hold_ns_(hold_ns) {}
  void push(std::int64_t time_ns, wire::ByteView frame);
  void finish();  ///< gives away all that is held

 private:
  FrameSink sink_;
  std::int64_t hold_ns_;
  ReorderBuffer<wire::Bytes> held_;
};

/// The maker of a frame, identified by its hardware addresses.
enum class FrameOrigin : std::uint8_t {
  Recorded,   ///< crisp, of what a device sent
  Simulated,  ///< crisp, of what a simulated device sent
  Foreign,    ///< a network card
};

FrameOrigin origin_of(wire::ByteView frame);

/// Sets a frame's hardware addresses to those of a simulated one.
void mark_as_simulated(wire::Bytes& frame);

/// Parameters of a TCP connection on the wire.
struct TcpSettings {
  std::size_t largest_segment = 1460;  ///< [bytes] of payload: what fits in Ethernet's 1500
  double ns_per_byte = 80;             ///< [ns] 100 Mbit/s: how far apart the segments of one telegram are
  std::int64_t ack_delay_ns = 40'000;  ///< [ns] from the last segment to the acknowledgement
  std::uint32_t server_sequence = 1'000'000;  ///< initial sequence numbers
  std::uint32_t client_sequence = 2'000'000;
};

enum class TcpSide : std::uint8_t { Server, Client };

/// One TCP connection over Ethernet as a third party captures it: right headers, checksums, sequence and
/// acknowledgement numbers. Addresses are IPv4 or IPv6.
class TcpConversation {
 public:
  /// @throws Error if an address is none, or of another family than the other
  TcpConversation(const Address& server, const Address& client, FrameSink sink, TcpSettings settings = {});

  /// The three segments of the handshake, the last of them at time_ns.
  void open(std::int64_t time_ns);
  /// Payload bytes in as many segments as they need; the last is captured at completed_ns, those before it
  /// earlier by what the wire needs, and the other side acknowledges them.
  void send(TcpSide from, wire::ByteView bytes, std::int64_t completed_ns);
  /// Both sides finish, the client first.
  void close(std::int64_t time_ns);

 private:
  struct Side {
    Address address;
    std::uint32_t sequence = 0;
    std::uint16_t packets = 0;  ///< IPv4's identification
  };

  Side& side(TcpSide which) { return which == TcpSide::Server ? server_ : client_; }
  void segment(TcpSide from, int flags, wire::ByteView payload, std::int64_t time_ns);

  Side server_, client_;
  FrameSink sink_;
  TcpSettings settings_;
};

/// A sender of UDP datagrams, as a third party captures it.
class DatagramSender {
 public:
  /// @throws Error as TcpConversation
  DatagramSender(Address from, Address to, FrameSink sink);
  void send(wire::ByteView bytes, std::int64_t time_ns);

 private:
  Address from_, to_;
  FrameSink sink_;
  std::uint16_t packets_ = 0;
};

}  // namespace crisp::capture
