// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include <crisp/cloud.hpp>

namespace crisp::test {

/// A cloud of these points [m], all of one laser.
inline Cloud picture_cloud(const std::vector<std::array<float, 3>>& points, std::uint16_t laser = 0) {
  Cloud cloud;
  for (const auto& [x, y, z] : points) {
    Point point;
    point.x = x;
    point.y = y;
    point.z = z;
    point.laser = laser;
    cloud.push_back(point);
  }
  return cloud;
}

}  // namespace crisp::test
