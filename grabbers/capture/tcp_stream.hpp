// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "grabbers/devices/network.hpp"

namespace crisp::capture {

/// Receives the bytes of a TCP stream, in the order of sending.
class StreamSink {
 public:
  virtual ~StreamSink() = default;
  /// The next bytes. @param arrival_ns [ns] capture time of the packet that first brought them
  virtual void data(wire::ByteView bytes, std::int64_t arrival_ns) = 0;
  /// Bytes are missing here, or a new connection begins.
  virtual void gap() = 0;
  /// A segment whose bytes were all there before.
  virtual void repeated(wire::ByteView bytes) = 0;
};

/// One direction of a TCP connection, reassembled: segments may come in any order, twice, overlapping, or not
/// at all, and the capture may begin in mid-connection. Bytes keep the time of the packet that first brought
/// them. A hole is waited for, but not for longer than `max_wait_ns` of capture time or more than 4 MiB
/// behind it.
///
/// A segment far from the stream's position is either damaged or of a new connection whose begin was not
/// captured: it is held until the next segment decides.
class TcpStream {
 public:
  struct Counts {
    std::uint64_t repeated_segments = 0;
    std::uint64_t late_segments = 0;  ///< came after bytes that follow theirs
    std::uint64_t lost_bytes = 0;     ///< never came
    std::uint64_t holes = 0;          ///< in how many places
    std::uint64_t connections = 0;    ///< begun, seen or not
    std::uint64_t out_of_window = 0;  ///< segments that fit nowhere
  };

  TcpStream(StreamSink& sink, std::int64_t max_wait_ns) : sink_(sink), max_wait_ns_(max_wait_ns) {}

  void take(const devices::TransportPacket& segment, std::int64_t time_ns);
  /// Gives up holes that have timed out.
  void expire(std::int64_t now_ns);
  /// The capture ends: gives what waits behind holes.
  void finish();

  /// [ns] Arrival of the oldest byte that waits for others, if any does.
  std::optional<std::int64_t> waiting_since() const {
    return held_.empty() && !held_segment_ ? std::nullopt
                                           : oldest_waiting();  // called for each packet: mostly empty
  }

  const Counts& counts() const { return counts_; }

 private:
  struct Held {
    wire::Bytes bytes;
    std::int64_t arrival_ns = 0;
  };

  bool is_handshake_again(std::uint32_t sequence, std::int64_t time_ns) const;
  void begin(std::uint32_t sequence, std::int64_t time_ns);
  void place(std::uint32_t sequence, wire::ByteView bytes, std::uint32_t missing, std::int64_t time_ns);
  void deliver(wire::ByteView bytes, std::int64_t arrival_ns);
  void hold(std::uint64_t offset, wire::ByteView bytes, std::int64_t time_ns);
  void release();
  void skip_hole();
  void drop_held_segment();
  std::optional<std::int64_t> oldest_held() const;
  std::optional<std::int64_t> oldest_waiting() const;
  void jump_to(std::uint64_t offset);
  bool continues_held_segment(std::uint32_t sequence, wire::ByteView bytes, std::int64_t time_ns);

  StreamSink& sink_;
  std::int64_t max_wait_ns_;
  bool begun_ = false;
  std::int64_t begun_ns_ = 0;
  bool over_ = false;           ///< a side has ended the connection
  std::uint32_t first_ = 0;     ///< sequence number of the first byte
  std::uint64_t position_ = 0;  ///< of the next byte to deliver, counted from the first
  std::map<std::uint64_t, Held> held_;
  std::size_t held_bytes_ = 0;
  struct HeldSegment {  ///< a segment that may begin a new connection
    std::uint32_t sequence;
    wire::Bytes bytes;
    std::int64_t arrival_ns;
  };
  std::optional<HeldSegment> held_segment_;
  Counts counts_;
};

}  // namespace crisp::capture
