// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <utility>

namespace crisp::capture {

/// Reorder buffer: holds items that come slightly out of order, and gives them in the order of their times.
/// Items of equal times keep their order.
template <class T>
class ReorderBuffer {
 public:
  struct Timed {
    std::int64_t time_ns = 0;
    T item;
  };

  void push(std::int64_t time_ns, T item) {
    const auto is_later = [](std::int64_t time, const Timed& other) { return time < other.time_ns; };
    const bool is_last = items_.empty() || items_.back().time_ns <= time_ns;  // as nearly all are
    const auto place =
        is_last ? items_.end() : std::upper_bound(items_.begin(), items_.end(), time_ns, is_later);
    items_.insert(place, Timed{time_ns, std::move(item)});
  }

  /// The earliest item, if its time is before `limit_ns`.
  std::optional<Timed> pop(std::int64_t limit_ns = std::numeric_limits<std::int64_t>::max()) {
    if (!has(limit_ns)) return {};
    Timed first = std::move(items_.front());
    items_.pop_front();
    return first;
  }

  /// Whether pop() would give an item.
  bool has(std::int64_t limit_ns) const { return !items_.empty() && items_.front().time_ns < limit_ns; }
  bool empty() const { return items_.empty(); }
  std::int64_t first_ns() const { return items_.front().time_ns; }  ///< of one that is not empty
  std::int64_t last_ns() const { return items_.back().time_ns; }    ///< of one that is not empty

 private:
  std::deque<Timed> items_;  ///< ascending in time
};

}  // namespace crisp::capture
