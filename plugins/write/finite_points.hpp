// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/common/point_tests.h>

#include <cmath>
#include <cstdint>

#include <crisp/cloud.hpp>
#include <crisp/error.hpp>

namespace crisp::write {

/// Name of the count of points that for_each_finite_point() drops.
inline constexpr const char* kNotFinite = "points with coordinates that are no numbers";

/// Calls `use` for each point of a cloud whose position and time are numbers, with its time since `stamp`.
/// @param stamp  [µs since the Unix epoch] of the file; the same for all clouds of a run of crisp
/// @return how many points were left out
template <class Use>
std::size_t for_each_finite_point(const Cloud& cloud, std::uint64_t stamp, Use use) {
  const double shift = 1e-6 * (static_cast<double>(cloud.header.stamp) - static_cast<double>(stamp));
  std::size_t lost = 0;
  for (Point point : cloud) {
    point.time += shift;
    if (!pcl::isXYZFinite(point) || !std::isfinite(point.time)) {
      ++lost;
      continue;
    }
    use(point);
  }
  return lost;
}

inline Error no_point_came() {
  return Error("there are no points, so no cloud to write",
               "see the losses and warnings above for the cause; without any, no stage above gave one");
}

}  // namespace crisp::write
