// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include <crisp/capture_statistics.hpp>
#include <crisp/live_settings.hpp>
#include <crisp/rig.hpp>

#include "grabbers/devices/wired_encoder.hpp"
#include "grabbers/live/item_queue.hpp"
#include "grabbers/live/plate_receiver.hpp"
#include "grabbers/live/sick_client.hpp"

namespace crisp::live {

/// The devices of a rig over the network: scans and readings in the order in which this process receives
/// them. It retries unreachable devices; the source ends only when it is stopped.
class LiveSource final : public ItemSource {
 public:
  /// Connects from now on, in a thread of its own.
  /// @throws Error if an address of the rig is none, or the plate's cannot be listened at
  explicit LiveSource(const Rig& rig, const LiveSettings& settings = {});
  ~LiveSource() override;

  std::optional<HubItem> next() override;
  /// The next item; nothing if none came in time. After interrupt(), what came before.
  std::optional<HubItem> next_within(std::chrono::milliseconds plate_timeout) {
    return queue_.pop(plate_timeout);
  }

  /// Items that wait to be taken.
  std::size_t waiting() const { return queue_.size(); }

  /// Ends the connections: within 100 ms, whatever the network does.
  void interrupt() override;

  /// Received and lost telegrams so far. Damage within a connection is counted when it has ended.
  CaptureStatistics statistics();
  /// interrupt(), waited for. @return all that came, and was lost
  CaptureStatistics close();

  /// The hub's port that the plate's datagrams are taken at; 0 without a plate.
  std::uint16_t plate_port() const { return plate_ ? plate_->port() : std::uint16_t{0}; }

 private:
  void stop_devices();
  void in_thread(const std::function<void()>& work);
  void end_thread();

  ItemQueue queue_;
  std::vector<std::unique_ptr<devices::DeviceLog>> logs_;
  boost::asio::io_context context_{1};
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_;
  std::vector<std::unique_ptr<SickClient>> lasers_;
  std::unique_ptr<devices::WiredEncoder> wired_encoder_;
  std::unique_ptr<PlateReceiver> plate_;
  std::thread thread_;
};

}  // namespace crisp::live
