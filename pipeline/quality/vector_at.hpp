// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include <crisp/points.hpp>

namespace crisp::quality {

/// The i-th of a struct of arrays: a point [m] or a direction.
inline Eigen::Vector3d vector_at(const PointsView& points, std::size_t i) {
  return {points.x[i], points.y[i], points.z[i]};
}

}  // namespace crisp::quality
