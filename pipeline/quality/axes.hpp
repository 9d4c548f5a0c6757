// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <span>

#include <crisp/points.hpp>

namespace crisp::quality {

/// The coordinates of points, axis by axis.
inline std::array<std::span<const double>, 3> axes(const PointsView& points) {
  return {points.x, points.y, points.z};
}

}  // namespace crisp::quality
