// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "pipeline/data/recordings.hpp"

namespace crisp {

/// The pauses of a capture, longer than kPause, in which nothing came from any device: what divides its
/// recordings.
class Pauses {
 public:
  /// An item came from any of the devices.
  void hear(std::int64_t time_ns) {
    const auto before = newest_ns_.value_or(time_ns);
    newest_ns_ = std::max(before, time_ns);
    if (1e-9 * static_cast<double>(time_ns - before) <= kPause) return;
    last_begin_ns_ = before;
    last_end_ns_ = time_ns;
    ++count_;
    seconds_ += 1e-9 * static_cast<double>(time_ns - before);
  }

  /// Whether the last pause lies between two items of a device.
  bool last_is_between(std::int64_t before_ns, std::int64_t after_ns) const {
    return count_ > 0 && before_ns <= last_begin_ns_ && after_ns >= last_end_ns_;
  }

  std::uint64_t count() const { return count_; }
  double seconds() const { return seconds_; }  ///< [s] in all

 private:
  std::optional<std::int64_t> newest_ns_;
  std::int64_t last_begin_ns_ = 0, last_end_ns_ = 0;
  std::uint64_t count_ = 0;
  double seconds_ = 0;
};

}  // namespace crisp
