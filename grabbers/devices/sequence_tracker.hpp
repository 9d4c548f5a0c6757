// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "pipeline/clocks/unwrap.hpp"

namespace crisp::devices {

/// Watches a counter that wraps at 65536: what was lost, came twice or came late. A silence longer than a
/// wrap is counted right with the help of the time that it took and the usual interval.
class SequenceTracker {
 public:
  enum class Verdict : std::uint8_t { First, Next, Late, Duplicate };

  /// @param counter of the item that came
  /// @param stamp   something that differs between items: the same counter with another one is no duplicate
  /// @param time_ns [ns] when it came
  Verdict take(std::uint16_t counter, std::uint32_t stamp, std::int64_t time_ns);

  /// The device began anew: the next counter is the first.
  void restart() { begun_ = false; }

  std::uint64_t lost() const { return lost_; }

 private:
  static constexpr std::int64_t kRemembered = 64;

  std::int64_t steps_to(std::uint16_t counter, std::int64_t time_ns) const;
  Verdict begin(std::uint16_t counter, std::uint32_t stamp, std::int64_t time_ns);

  bool begun_ = false;
  clocks::CounterUnwrapper last_;
  std::int64_t last_ns_ = 0;
  double elapsed_ns_ = 0, steps_ = 0;  ///< of the last items: their ratio is the time from one to the next
  std::uint64_t seen_ = 0;             ///< bit k: counter last − k has come
  std::array<std::uint32_t, kRemembered> stamps_{};
  std::uint64_t lost_ = 0;
};

}  // namespace crisp::devices
