// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>

#include <crisp/hub_item.hpp>

namespace crisp::live {

/// Between devices, which do not wait, and a pipeline that may be slow: what does not fit pushes the oldest
/// out, and is counted.
class ItemQueue {
 public:
  explicit ItemQueue(std::size_t most) : most_(most) {}

  void push(HubItem item) {
    {
      const std::lock_guard lock(mutex_);
      if (closed_) return;
      if (items_.size() >= most_) {
        items_.pop_front();
        ++dropped_;
      }
      items_.push_back(std::move(item));
    }
    changed_.notify_one();
  }

  /// The oldest item; nothing if none came in time, or the queue is closed and empty.
  std::optional<HubItem> pop(std::chrono::milliseconds plate_timeout) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, plate_timeout, [this] { return closed_ || !items_.empty(); });
    if (items_.empty()) return {};
    HubItem item = std::move(items_.front());
    items_.pop_front();
    return item;
  }

  /// Nothing goes in any more.
  void close() {
    {
      const std::lock_guard lock(mutex_);
      closed_ = true;
    }
    changed_.notify_all();
  }

  std::size_t size() const {
    const std::lock_guard lock(mutex_);
    return items_.size();
  }
  bool closed() const {
    const std::lock_guard lock(mutex_);
    return closed_;
  }
  std::uint64_t dropped() const {
    const std::lock_guard lock(mutex_);
    return dropped_;
  }

 private:
  const std::size_t most_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<HubItem> items_;
  std::uint64_t dropped_ = 0;
  bool closed_ = false;
};

}  // namespace crisp::live
