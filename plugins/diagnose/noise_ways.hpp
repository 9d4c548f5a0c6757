// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "pipeline/data/calibration.hpp"
#include "plugins/diagnose/noise_law.hpp"

namespace crisp {

/// One way in which noise may be other than normal.
struct NoiseWay {
  std::string cause;                         ///< in the catalogue; empty: a mere description
  std::function<void(NoiseLaw&)> add;        ///< a start from which it can be fitted
  std::function<void(NoiseLaw&)> take_away;  ///< its contrary
  std::function<std::vector<Parameter>(const NoiseLaw&)> parameters;
  /// Those besides, with standard errors, that only the ranges themselves tell; none: there are none.
  std::function<std::vector<Parameter>(const NoiseLaw&, const RangeErrors&)> told_by_ranges = nullptr;
};

/// Whether anything can go by these values: there are some, and not all are alike.
bool are_various(std::span<const float> values);

/// All that these errors can show: not what goes by something that is not known of them, or does not change.
///
/// @param sigma  [m] of the normal law, as a measure
std::vector<NoiseWay> noise_ways(const RangeErrors& errors, double sigma);

}  // namespace crisp
