// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace crisp {

/// When the hub received a telegram, and by how much later than the device's clock says that it was sent.
struct ReceivedStamp {
  double hub = 0;   ///< [s]
  double lead = 0;  ///< [s] but for a constant
};

/// By how much the hub's clock deviates from a steady one: it was set, or made to run faster or slower (NTP).
class HubDeviation {
 public:
  struct Step {
    double at = 0;  ///< [s] hub time
    double by = 0;  ///< [s] forwards
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

/// The deviation that the clocks of several devices show alike: the least delays in short stretches of time
/// move together, by more than 50 µs, and no device whose delays are even enough to show it does otherwise.
///
/// Nothing where there is none, or where fewer than two devices show it: a deviation of one device is its
/// own. What is common to all as a steady rate belongs to their skews.
///
/// @param devices the stamps of each, ascending in `hub` but for what its steps did
std::optional<HubDeviation> find_hub_deviation(std::span<const std::vector<ReceivedStamp>> devices);

}  // namespace crisp
