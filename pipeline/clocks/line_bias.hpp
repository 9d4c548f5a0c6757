// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "pipeline/clocks/clock_line.hpp"

namespace crisp::clocks {

/// Bias of a line below stamps against their clock, as no stamp has the least delay.
struct LineBias {
  double mean = 0;       ///< [s]
  double std_error = 0;  ///< [s] of it
};

/// From the smallest delays x above the line: the share of delays below x is taken to grow as a power of x,
/// whose exponent is estimated from them (Hill: A simple general approach to inference about the tail of a
/// distribution, Annals of Statistics 1975).
///
/// @param stamps  those that the line was fitted to
/// @param quantum [s] the resolution of the stamps
LineBias estimate_line_bias(std::span<const Stamp> stamps, const ClockLine& line, double quantum);

}  // namespace crisp::clocks
