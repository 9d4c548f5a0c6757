// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>

#include <crisp/hub_item.hpp>

namespace crisp {

/// Puts items into the order of their receipt; of equal times the first that came goes first.
class ItemMerge {
 public:
  void push(HubItem item) {
    const auto time = receipt_ns(item);
    if (items_.empty() || receipt_ns(items_.back()) <= time) {  // as nearly all do
      items_.push_back(std::move(item));
      return;
    }
    const auto later = [](std::int64_t t, const HubItem& other) { return t < receipt_ns(other); };
    items_.insert(std::upper_bound(items_.begin(), items_.end(), time, later), std::move(item));
  }

  /// The next item, if it was received before `limit_ns`.
  std::optional<HubItem> pop(std::int64_t limit_ns = std::numeric_limits<std::int64_t>::max()) {
    if (!has(limit_ns)) return {};
    auto item = std::move(items_.front());
    items_.pop_front();
    return item;
  }

  /// Whether pop() would give something.
  bool has(std::int64_t limit_ns) const { return !items_.empty() && receipt_ns(items_.front()) < limit_ns; }
  bool empty() const { return items_.empty(); }

 private:
  std::deque<HubItem> items_;
};

}  // namespace crisp
