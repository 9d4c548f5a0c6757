// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/picture/colours.hpp"

#include <algorithm>
#include <cmath>

namespace crisp::write {

PictureRgb ramp_colour(double share) {
  const double at = std::clamp(share, 0.0, 1.0) * (kRamp.size() - 1);
  const std::size_t low = std::min(kRamp.size() - 2, static_cast<std::size_t>(at));
  const double weight = at - static_cast<double>(low);
  PictureRgb colour{};
  for (std::size_t k = 0; k < 3; ++k) {
    colour[k] =
        static_cast<std::uint8_t>(std::lround((1 - weight) * kRamp[low][k] + weight * kRamp[low + 1][k]));
  }
  return colour;
}

}  // namespace crisp::write
