// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/settings.hpp"

#include <fmt/format.h>

#include <cmath>

#include <crisp/error.hpp>

namespace crisp::simulate {

std::size_t FieldOfView::beams() const {
  constexpr double kTurn = 2 * std::numbers::pi;
  constexpr double kRounding = 1e-6;  // share of a step that the angles' rounding may cost
  if (!(step > 0)) {
    throw Error(fmt::format("the angle between a laser's beams is {:g} rad", step), "give a step above 0");
  }
  if (!(last >= first && last - first < kTurn)) {
    throw Error(fmt::format("a laser's field of view is from {:g} to {:g} rad", first, last),
                "give a last_angle that is above first_angle by less than a turn");
  }
  return static_cast<std::size_t>(std::floor((last - first) / step + kRounding)) + 1;
}

void check_plate_frequency(const ScannerSettings& settings) {
  if (settings.plate_frequency > 0) return;
  throw Error(fmt::format("the plate reports {:g} readings a second", settings.plate_frequency),
              "give a plate_frequency above 0 Hz");
}

}  // namespace crisp::simulate
