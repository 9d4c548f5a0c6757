// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <crisp/hub_item.hpp>
#include <crisp/rig.hpp>

#include "grabbers/emulate/emulated_laser.hpp"

namespace crisp::emulate {

struct EmulatorSettings {
  double speed = 1;              ///< speed relative to real time; 0: as fast as the clients read
  bool wait_for_clients = true;  ///< whether nothing is sent before each laser has somebody to send it to
  Address plate_to{"127.0.0.1", 4000};  ///< where the plate's datagrams go
  EmulatedFaults faults;
  bool network = false;  ///< whether addresses other than loopback may be listened at
};

/// The devices of a rig, on this machine's network: a TCP server a laser, and the plate's datagrams.
class Emulator {
 public:
  using Interrupted = std::function<bool()>;

  /// Listens from now on, in a thread of its own.
  /// @param rig  whose lasers have addresses of this machine; port 0: any that is free
  /// @throws Error if the speed is negative or no number, an address is none or not loopback (unless
  /// allowed), or
  ///         cannot be listened at
  Emulator(Rig rig, EmulatorSettings settings);
  ~Emulator();
  Emulator(const Emulator&) = delete;
  Emulator& operator=(const Emulator&) = delete;

  /// The rig with the ports that are listened at.
  const Rig& rig() const { return rig_; }

  /// Sends an item when it is due: as long after the first as it was received after it, divided by the speed.
  /// At speed 0, once each laser has somebody to send it to, and who has taken most of what was sent before.
  /// Returns earlier, without sending it, once `interrupted`.
  ///
  /// Where clients are waited for at another speed than 0, the first items are kept until each laser had a
  /// scan, for a second of them at most: a laser answers as its scans will be before it sends the first one.
  void send(const HubItem& item, const Interrupted& interrupted);

  /// Names of the lasers whose scans no client has requested.
  std::vector<std::string> without_client();

  /// Whether anything was sent.
  bool has_begun() const { return start_.has_value(); }

  /// Sends what was kept, and waits until the clients have taken all that was sent, for 2 s at most.
  void finish(const Interrupted& interrupted = [] { return false; });

  /// Counts of the faults so far.
  EmulatedLedger ledger();

 private:
  void check(const EmulatorSettings& settings) const;
  void await_clients(const Interrupted& interrupted);
  void await_time(std::int64_t item_ns, const Interrupted& interrupted);
  void keep(const HubItem& item);
  bool keeps_on() const;
  void begin(const Interrupted& interrupted);
  void deliver(const HubItem& item, const Interrupted& interrupted);
  void send(const PlateReading& reading);
  double skew_of(std::size_t laser) const;
  void in_thread(const std::function<void()>& work);
  std::size_t waiting_bytes();

  Rig rig_;
  EmulatorSettings settings_;
  boost::asio::io_context context_{1};
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_;
  std::vector<std::unique_ptr<EmulatedLaser>> lasers_;
  boost::asio::ip::udp::socket plate_;
  boost::asio::ip::udp::endpoint plate_to_;
  struct Start {
    std::chrono::steady_clock::time_point here;
    std::int64_t item_ns = 0;
  };
  std::optional<Start> start_;          ///< when the first item was sent, and received
  std::vector<HubItem> kept_;           ///< until then
  std::set<std::uint16_t> introduced_;  ///< lasers that had a scan
  FaultDice plate_dice_;
  EmulatedLedger plate_ledger_;
  std::thread thread_;
};

}  // namespace crisp::emulate
