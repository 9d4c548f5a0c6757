// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>

#include "plugins/diagnose/clocks/clock_stamps.hpp"

namespace crisp::diagnose {

/// [s] Lasting jump of a device's time at a stamp beyond its counter. A single late telegram does not count,
/// since the next one compensates it.
double device_jump(std::span<const CountedStamp> stamps, std::size_t at);

/// Index of the stamp with the largest jump of the device's time in a range, which excludes the first stamp
/// of all.
std::size_t largest_device_jump(std::span<const CountedStamp> stamps, std::size_t begin, std::size_t end);

/// log10 of the Bayes factor for a jump of the device's clock before a stamp against none. The jump's error
/// follows Student's t with three degrees of freedom, since single telegrams are sent late. Its scale is that
/// of the intervals between the surrounding stamps.
///
/// @param by  [s] jump, forward
double log10_odds_of_jump(std::span<const CountedStamp> stamps, std::size_t at, double by);

}  // namespace crisp::diagnose
