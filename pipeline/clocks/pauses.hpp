// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "pipeline/data/recordings.hpp"

namespace crisp::clocks {

/// The pauses in what a hub receives, longer than kPause, in which nothing came from any device: what divides
/// its recordings.
class Pauses {
 public:
  /// Notes an item of any of the devices. @return whether a pause ends with it
  bool hear(std::int64_t time_ns) {
    const bool ends_here = end_before(time_ns);
    if (ends_here) {
      last_begin_ns_ = *newest_ns_;
      last_end_ns_ = time_ns;
      ++count_;
      seconds_ += silence_before(time_ns);
    }
    newest_ns_ = std::max(newest_ns_.value_or(time_ns), time_ns);
    return ends_here;
  }

  /// Whether a pause would end with an item that is received then.
  bool end_before(std::int64_t time_ns) const { return data::is_pause(silence_before(time_ns)); }

  /// Whether the last pause lies between two items of a device.
  bool last_is_between(std::int64_t before_ns, std::int64_t after_ns) const {
    return count_ > 0 && before_ns <= last_begin_ns_ && after_ns >= last_end_ns_;
  }

  std::uint64_t count() const { return count_; }
  double seconds() const { return seconds_; }  ///< [s] in all

 private:
  /// [s] How long nothing has come until then; negative for an item that came late.
  double silence_before(std::int64_t time_ns) const {
    return 1e-9 * static_cast<double>(time_ns - newest_ns_.value_or(time_ns));
  }

  std::optional<std::int64_t> newest_ns_;
  std::int64_t last_begin_ns_ = 0, last_end_ns_ = 0;
  std::uint64_t count_ = 0;
  double seconds_ = 0;
};

}  // namespace crisp::clocks
