// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/settings.hpp"

#include <cmath>

#include "pipeline/data/error.hpp"

namespace crisp {

std::size_t FieldOfView::beams() const {
  constexpr double kTurn = 2 * std::numbers::pi;
  constexpr double kRounding = 1e-6;  // share of a step that the angles' rounding may cost
  if (!(step > 0)) throw Error("a laser's angular step must be positive");
  if (!(last >= first && last - first < kTurn)) {
    throw Error("a laser's field of view must not be empty, nor wider than a turn");
  }
  return static_cast<std::size_t>(std::floor((last - first) / step + kRounding)) + 1;
}

}  // namespace crisp
