// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>

#include "plugins/diagnose/stamps.hpp"

namespace crisp {

/// By how much a device's time since the stamp before is longer than its counter says, for good [s]: what one
/// telegram alone was sent late is made up for by the next.
double device_jump(std::span<const CountedStamp> stamps, std::size_t at);

/// Where in a stretch of stamps, none of them the first of all, the device's time jumps most.
std::size_t largest_device_jump(std::span<const CountedStamp> stamps, std::size_t begin, std::size_t end);

/// The odds that the device's clock was put forward before a stamp against that it went on. What its time is
/// off there follows Student's law of three degrees of freedom, for telegrams are sent late one by one; its
/// width is that of the intervals between stamps around.
///
/// @param by  [s] put forward
double log10_odds_of_jump(std::span<const CountedStamp> stamps, std::size_t at, double by);

}  // namespace crisp
