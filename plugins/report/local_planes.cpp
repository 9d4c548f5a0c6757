// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/report/local_planes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pipeline/quality/vector_at.hpp"
#include "plugins/report/cell_runs.hpp"

namespace crisp::report {
namespace {

constexpr unsigned kLevels = 2;       // the cells' side is doubled twice
constexpr double kMaxFlatness = 0.2;  // spread across the plane over that along it
constexpr std::size_t kMin = 12;      // points of a plane

quality::Plane plane_of_run(const CellRun& run, const PointsView& points,
                            const quality::SpatialOrder& order) {
  quality::Moments moments;
  const std::uint32_t first = order.index[run.begin];
  const Eigen::Vector3d origin = quality::vector_at(points, first);
  for (std::size_t k = run.begin; k < run.end; ++k) {
    const std::uint32_t i = order.index[k];
    moments.add(quality::vector_at(points, i) - origin);
  }
  quality::Plane plane = quality::plane_of(moments);
  plane.middle += origin;
  if (plane.normal.dot(plane.middle) > 0) plane.normal = -plane.normal;
  return plane;
}

}  // namespace

double LocalPlanes::distance(std::size_t point, const PointsView& points) const {
  if (of[point] == kNone) return std::numeric_limits<double>::quiet_NaN();
  return planes[of[point]].distance(quality::vector_at(points, point));
}

double LocalPlanes::incidence(std::size_t point, const Eigen::Vector3d& direction) const {
  if (of[point] == kNone) return std::numeric_limits<double>::quiet_NaN();
  return std::acos(std::min(1.0, std::abs(planes[of[point]].normal.dot(direction.normalized()))));
}

LocalPlanes local_planes(const PointsView& points, const quality::SpatialOrder& order) {
  LocalPlanes found{.planes = {}, .of = std::vector(points.size(), LocalPlanes::kNone)};
  for (const CellRun& run : cell_runs(order, kLevels)) {
    if (run.size() < kMin) continue;
    const quality::Plane plane = plane_of_run(run, points, order);
    if (!(plane.extent[0] < kMaxFlatness * plane.extent[1])) continue;
    for (std::size_t k = run.begin; k < run.end; ++k) {
      found.of[order.index[k]] = static_cast<std::uint32_t>(found.planes.size());
    }
    found.planes.push_back(plane);
  }
  return found;
}

}  // namespace crisp::report
