// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <crisp/points.hpp>

#include "pipeline/quality/plane.hpp"
#include "pipeline/quality/spatial_order.hpp"

namespace crisp::report {

/// A plane fitted to the points of each cell that is flat; its normal points towards the scanner, at the
/// origin.
struct LocalPlanes {
  static constexpr std::uint32_t kNone = UINT32_MAX;

  std::vector<quality::Plane> planes;
  std::vector<std::uint32_t> of;  ///< of each point: index of its plane; kNone where its cell is not flat

  /// [m] From its plane, towards the scanner at the origin; NaN where it has none.
  double distance(std::size_t point, const PointsView& points) const;
  /// [rad] Between the plane's normal and a beam's direction, 0 to π/2; NaN where it has none.
  double incidence(std::size_t point, const Eigen::Vector3d& direction) const;
};

/// Total least squares in each cell whose side is four times that of the order's. A cell is flat where its
/// points are spread across the plane by less than a fifth of what they are along it.
LocalPlanes local_planes(const PointsView& points, const quality::SpatialOrder& order);

}  // namespace crisp::report
