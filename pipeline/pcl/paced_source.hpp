// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>

#include <crisp/hub_item.hpp>

namespace crisp::pcl_grabber {

/// Gives another source's items at the pace of their receipt.
class PacedSource final : public ItemSource {
 public:
  /// @param speed how many times faster than real time, > 0
  PacedSource(std::unique_ptr<ItemSource> source, double speed) : source_(std::move(source)), speed_(speed) {}

  std::optional<HubItem> next() override;
  void interrupt() override;

 private:
  using Clock = std::chrono::steady_clock;
  struct Start {
    Clock::time_point here;
    std::int64_t hub_ns;
  };

  std::unique_ptr<ItemSource> source_;
  double speed_;
  std::optional<Start> start_;  ///< when the first item was given, and received
  std::mutex mutex_;
  std::condition_variable changed_;
  bool interrupted_ = false;
};

}  // namespace crisp::pcl_grabber
