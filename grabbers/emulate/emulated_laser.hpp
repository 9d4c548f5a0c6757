// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <crisp/rig.hpp>

#include "grabbers/emulate/emulated_faults.hpp"
#include "grabbers/emulate/scan_restamper.hpp"
#include "grabbers/emulate/sick_responder.hpp"

namespace crisp::emulate {

/// A TCP server that speaks as a laser does, to as many clients as come. All of it happens in the thread that
/// runs the io_context.
class EmulatedLaser {
 public:
  /// Listens from now on, but answers only once the io_context runs.
  /// @param address  of this machine; port 0: any that is free
  /// @param longest_idle  clients that have neither sent nor taken anything for so long give way where there
  /// are too
  ///                      many (16)
  /// @throws Error if it cannot be listened at
  EmulatedLaser(boost::asio::io_context& context, const Address& address, FaultDice dice,
                const EmulatedClock& clock, std::chrono::milliseconds longest_idle = std::chrono::seconds(5));
  ~EmulatedLaser();
  EmulatedLaser(const EmulatedLaser&) = delete;
  EmulatedLaser& operator=(const EmulatedLaser&) = delete;

  std::uint16_t port() const { return port_; }
  void start() { accept(); }
  void stop();

  /// A scan as those that will be sent, by which the laser answers how it scans.
  void introduce(wire::ScanData scan) { device_.last = std::move(scan); }
  /// Sends a scan to all who subscribed. Who does not read what was sent misses it.
  void send(wire::ScanData scan);

  /// Counts of the faults so far.
  const EmulatedLedger& ledger() const { return ledger_; }

  std::size_t subscribers() const;
  std::size_t waiting_bytes() const;  ///< that the slowest client has not taken yet

 private:
  class Session;
  void accept();
  void close_idle();
  void restart();
  void send(Session& session, const wire::ScanData& scan);

  boost::asio::ip::tcp::acceptor acceptor_;
  std::uint16_t port_ = 0;
  EmulatedDevice device_;
  FaultDice dice_;
  EmulatedClock clock_;
  std::chrono::milliseconds longest_idle_;
  EmulatedLedger ledger_;
  std::vector<std::shared_ptr<Session>> sessions_;
};

}  // namespace crisp::emulate
