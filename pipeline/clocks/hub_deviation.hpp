// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace crisp::clocks {

/// The hub's time of receipt of a telegram, and its delay against the device's time stamp of sending.
struct ReceivedStamp {
  double hub = 0;   ///< [s]
  double lead = 0;  ///< [s] but for a constant
};

/// Deviation of the hub's clock from a uniform one: it was set, or slewed (NTP).
class HubDeviation {
 public:
  struct Step {
    double at = 0;  ///< [s] hub time: the middle of what the clock left out, or had twice
    double by = 0;  ///< [s] forwards
    double begin() const { return at - (by > 0 ? by / 2 : 0); }  ///< [s] hub time before it was set
  };

  /// [s] At a receipt; constant before the first and after the last one known.
  double at(double hub) const;
  /// Whether a receipt is so near to a step that it may have come before or after it.
  bool is_unsure(double hub) const;
  double at_end() const { return values_.empty() ? 0 : values_.back(); }  ///< [s]
  double largest() const;                                                 ///< [s] range of the values
  std::span<const Step> steps() const { return steps_; }

 private:
  friend class DeviationSeries;
  std::vector<double> times_;   // [s] ascending
  std::vector<double> values_;  // [s]
  std::vector<Step> steps_;
  double width_ = 0;  // [s] of what is unsure on either side of a step
};

/// Estimates the hub clock's deviation, which the clocks of several devices share: their least delays in
/// short stretches of time move together by more than 50 µs, and no device with steady delays contradicts.
///
/// Empty if there is none, or if fewer than two devices show it: a deviation of one device is its own. A
/// steady rate common to all devices belongs to their skews.
///
/// @param devices the stamps of each, ascending in `hub` but for what its steps did
std::optional<HubDeviation> find_hub_deviation(std::span<const std::vector<ReceivedStamp>> devices);

}  // namespace crisp::clocks
