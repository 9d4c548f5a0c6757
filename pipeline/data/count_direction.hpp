// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace crisp {

/// Which way a plate turns while its encoder counts up, seen from +z.
enum class CountDirection : std::uint8_t {
  counter_clockwise,
  clockwise,
  automatic  ///< of a rig: not known; a calibration finds it, until then counter_clockwise is assumed
};

}  // namespace crisp
