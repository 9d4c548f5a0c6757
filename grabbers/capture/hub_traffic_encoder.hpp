// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <crisp/rig.hpp>
#include <crisp/scan.hpp>

#include "grabbers/capture/frame_builder.hpp"
#include "grabbers/wire/cola.hpp"

namespace crisp::capture {

/// Encodes the data of a rig's devices as frames on the hub's network interface: a TCP connection a
/// laser, over which the hub has subscribed to scans, and the plate's datagrams.
class HubTrafficEncoder {
 public:
  /// @throws Error if an address of the rig is none, or the hub's own (192.168.0.100, fe80::100)
  HubTrafficEncoder(const Rig& rig, ColaLanguage language, FrameSink sink);

  /// Opens a laser's first connection, or a new one; its handshake and subscription end 2 ms after time_ns.
  void connect(std::size_t laser, std::int64_t time_ns);
  /// A framed telegram of a connected laser, complete at time_ns.
  void telegram(std::size_t laser, wire::ByteView bytes, std::int64_t time_ns);
  /// The plate's datagram of a reading; nothing where its encoder is wired to a laser, whose telegrams hold
  /// it.
  void reading(const PlateReading& reading);
  /// Ends all connections.
  void close(std::int64_t time_ns);

 private:
  std::vector<Address> addresses_;
  ColaLanguage language_;
  FrameSink sink_;
  std::vector<std::unique_ptr<TcpConversation>> lasers_;
  std::size_t connections_ = 0;
  std::optional<DatagramSender> plate_;
};

}  // namespace crisp::capture
