// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "pipeline/clocks/clock_line.hpp"
#include "pipeline/clocks/unwrap.hpp"

namespace crisp::devices {

/// A rough estimate of a device's microsecond clock that wraps at 2^32: its resets and its skew. The clock
/// stages estimate them accurately; here memory is constant.
class RoughClock {
 public:
  /// @return whether the clock was set since the last item: it fell back by more than 0.5 s, or ran ahead of
  ///         the hub's by more than a minute. What was known of its rate is then forgotten.
  bool take(const clocks::DeviceStamp& stamp);

  /// Forgets everything before.
  void restart() { begun_ = false; }

  /// Hub seconds per device second, less 1: the slope of the lower convex hull in the middle. Nothing before
  /// 10 s of device time, where delays decide.
  std::optional<double> skew() const;

 private:
  void begin(const clocks::DeviceStamp& stamp);
  void keep(const clocks::Stamp& stamp);

  bool begun_ = false;
  clocks::DeviceStamp last_;
  std::int64_t first_ns_ = 0;
  std::int64_t elapsed_us_ = 0;        ///< device time since the first stamp, unwrapped
  double width_ = 1;                   ///< [s] of device time in which only the least delay is kept
  std::vector<clocks::Stamp> lowest_;  ///< in ascending device time
};

}  // namespace crisp::devices
