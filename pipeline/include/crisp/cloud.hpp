// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/point_cloud.h>

#include <crisp/point.hpp>

namespace crisp {

/// Points in the plate's frame, in the order of firing. header.stamp is PCL's: the epoch of `Point::time`
/// in microseconds since the Unix epoch.
using Cloud = pcl::PointCloud<Point>;

}  // namespace crisp
