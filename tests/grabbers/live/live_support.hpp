// SPDX-License-Identifier: BSD-3-Clause
// What tests of live sources share.
#pragma once

#include <algorithm>
#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include <crisp/rig.hpp>

#include "grabbers/live/live_source.hpp"

namespace crisp::test {

/// For what comes within milliseconds, so that a busy machine fails nothing.
inline constexpr std::chrono::seconds kPatience{60};

/// The default rig with as many lasers, all of its devices at 127.0.0.1 and ports that are free.
inline Rig loopback_rig(std::size_t lasers = 3) {
  Rig rig = default_rig();
  rig.lasers.resize(lasers);
  for (RigLaser& laser : rig.lasers) laser.address = {"127.0.0.1", 0};
  rig.plate.address = {"127.0.0.1", 0};
  return rig;
}

/// A port for datagrams that nobody uses just now.
inline std::uint16_t free_datagram_port() {
  boost::asio::io_context context;
  const boost::asio::ip::udp::socket socket(context, {boost::asio::ip::make_address("127.0.0.1"), 0});
  return socket.local_endpoint().port();
}

inline Rig rig_of_one(std::uint16_t port) {
  Rig rig = loopback_rig(1);
  rig.lasers[0].address.port = port;
  return rig;
}

inline const DeviceStatistics& of(const CaptureStatistics& statistics, const std::string& name) {
  return *std::ranges::find(statistics.devices, name, &DeviceStatistics::name);
}

/// The hub's clock, which stands until it is set.
struct VirtualClock {
  std::atomic<std::int64_t> ns = 0;
  HubClock reader() {
    return [this] { return ns.load(); };
  }
};

/// Waits until a device's statistics fulfil a condition.
template <class Condition>
bool comes_true(live::LiveSource& source, const std::string& device, const Condition& condition) {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (std::chrono::steady_clock::now() < deadline) {
    const CaptureStatistics statistics = source.statistics();
    if (condition(of(statistics, device))) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

/// How often something was noted whose text begins so.
inline std::uint64_t count_beginning(const Counts& counts, std::string_view begin) {
  std::uint64_t n = 0;
  for (const auto& [what, times] : counts.all()) n += what.starts_with(begin) ? times : 0;
  return n;
}

}  // namespace crisp::test
