// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <string>

#include "pipeline/data/degree.hpp"

namespace crisp::data {

/// Unit in which people read a number.
struct ShownUnit {
  double factor = 1;  ///< from SI
  std::string name;   ///< empty for a plain number
};

/// Degrees, millimetres, milliseconds.
inline ShownUnit shown_unit(const std::string& unit) {
  if (unit == "rad") return {.factor = 1 / kDegree, .name = "deg"};
  if (unit == "m" || unit == "s") return {.factor = 1e3, .name = "m" + unit};
  return {.factor = 1, .name = unit == "1" ? "" : unit};
}

/// Number of decimals that show two significant digits of an error; negative for a large one.
///
/// @param error  > 0
inline int decimals_that_show(double error) { return 1 - static_cast<int>(std::floor(std::log10(error))); }

}  // namespace crisp::data
