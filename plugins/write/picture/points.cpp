// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/picture/points.hpp"

#include <cmath>

namespace crisp::write {

PicturePoints::PicturePoints(PictureColour colour, std::size_t most) : colour_(colour), most_(most) {}

float PicturePoints::value_of(const Point& point, std::uint64_t epoch) {
  switch (colour_) {
    case PictureColour::height:
      return point.z;
    case PictureColour::remission:
      return point.intensity;
    case PictureColour::time: {
      const double at = 1e-6 * static_cast<double>(epoch) + point.time;
      if (!first_) first_ = at;
      return static_cast<float>(at - *first_);
    }
    case PictureColour::laser:
      break;
  }
  return 0;
}

void PicturePoints::add(const Cloud& cloud) {
  for (const Point& point : cloud) {
    if (!std::isfinite(point.x) || !std::isfinite(point.y) || !std::isfinite(point.z)) continue;
    if (seen_++ % one_in_ != 0) continue;
    kept_.push_back({.x = point.x,
                     .y = point.y,
                     .z = point.z,
                     .value = value_of(point, cloud.header.stamp),
                     .laser = point.laser});
    if (kept_.size() < most_) continue;
    for (std::size_t i = 0; 2 * i < kept_.size(); ++i) kept_[i] = kept_[2 * i];
    kept_.resize((kept_.size() + 1) / 2);
    one_in_ *= 2;
  }
}

}  // namespace crisp::write
