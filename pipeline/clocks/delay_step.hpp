// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "pipeline/clocks/clock_line.hpp"

namespace crisp::clocks {

/// A step of a link's minimum delay.
struct DelayStep {
  double by = 0;          ///< [s] longer
  double std_error = 0;   ///< [s] of it
  std::size_t from = 0;   ///< the stamps from here to before `to` may have been sent before it or after it
  std::size_t first = 0;  ///< of them the first that seems to be after it
  std::size_t to = 0;
};

/// Detects a step in the lower envelope of one clock's stamps that is significant against the envelope's
/// scatter about a straight line with a step, and that no steady change of the clock's rate explains better.
///
/// Its size is the distance between the highest two parallel lines of which one lies below the stamps before
/// it and the other below those after it: line_by_convex_hull() with a step.
///
/// @param stamps ascending in device time
std::optional<DelayStep> step_of_delay(std::span<const Stamp> stamps);

}  // namespace crisp::clocks
