// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace crisp::clocks {

/// Detects jumps of a device's clock by the device's counter. The counted events come at even intervals
/// (turns of a mirror, readings of an encoder), so that a jump of the clock too small to be seen in the
/// receipts shows in one of the intervals.
///
/// A jump counts from the interval on in which it is detected, but is sure only after some even ones: a
/// single stamp may be off, which the next interval shows, or the intervals themselves may change.
class CountedTime {
 public:
  /// Adds the next interval.
  /// @param seconds [s] by the device's clock
  /// @param steps   of its counter, at least one
  /// @param hub     [s] by the receipts: they decide whether whole steps were left uncounted
  void add(double seconds, std::int64_t steps, double hub);
  /// Starts a new sequence, but keeps the jumps so far.
  void begin_anew();

  /// [s] All jumps of the clock so far, forwards: the device's time less this goes on as the count does.
  double jumped() const { return jumped_; }
  /// Whether the last interval's jump is surely one of the clock, or there was none.
  bool is_sure() const { return !trial_; }
  /// [s] The jump that has just become sure.
  std::optional<double> confirmed() const { return confirmed_; }

 private:
  struct Trial {
    double by = 0;         // [s]
    std::size_t even = 0;  // intervals since
  };
  std::optional<double> excess(double seconds, std::int64_t steps, double hub) const;
  void remember(double step);
  double largest_by_chance(double usual) const;
  void judge_trial(std::optional<double> jump);

  std::vector<double> latest_;   // [s] a step, of the latest intervals
  std::size_t next_ = 0;         // which of them is replaced next
  double usual_ = 0;             // [s] their median, of some intervals ago
  std::vector<double> spread_;   // [s] by which many intervals were off the median then
  std::size_t next_spread_ = 0;  // which of them is replaced next
  double jumped_ = 0;
  std::optional<Trial> trial_;
  std::optional<double> confirmed_;
};

}  // namespace crisp::clocks
