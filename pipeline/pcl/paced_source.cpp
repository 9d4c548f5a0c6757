// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/pcl/paced_source.hpp"

namespace crisp::pcl_grabber {

std::optional<HubItem> PacedSource::next() {
  auto item = source_->next();
  if (!item) return {};
  if (!start_) start_ = {Clock::now(), receipt_ns(*item)};
  const std::chrono::duration<double, std::nano> since(
      static_cast<double>(receipt_ns(*item) - start_->hub_ns) / speed_);
  std::unique_lock lock(mutex_);
  const auto due = start_->here + std::chrono::duration_cast<Clock::duration>(since);
  if (changed_.wait_until(lock, due, [this] { return interrupted_; })) return {};
  return item;
}

void PacedSource::interrupt() {
  {
    const std::lock_guard lock(mutex_);
    interrupted_ = true;
  }
  source_->interrupt();
  changed_.notify_all();
}

}  // namespace crisp::pcl_grabber
