// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// PCL's templates must see crisp's own point type, which no compiled PCL library knows.
#ifndef PCL_NO_PRECOMPILE
#define PCL_NO_PRECOMPILE
#endif
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/register_point_struct.h>

#include <cstdint>

namespace crisp {

/// A point of a crisp cloud. The name and type of each field is what a PCD file shows.
struct EIGEN_ALIGN16 Point {
  PCL_ADD_POINT4D;          ///< x, y, z [m] in the plate's frame
  float intensity = 0;      ///< remission, in the device's units
  std::uint16_t laser = 0;  ///< index of the laser in the rig
  std::uint16_t beam = 0;   ///< index of the beam in its scan
  double time = 0;          ///< [s since the epoch of the cloud's header]
  Point() {
    x = y = z = 0;
    data[3] = 1;  // homogeneous, as PCL's own points have it
  }
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};

/// Points in the plate's frame, in the order of firing. header.stamp is PCL's: the epoch of `Point::time`
/// in microseconds since the Unix epoch.
using Cloud = pcl::PointCloud<Point>;

}  // namespace crisp

// clang-format off
POINT_CLOUD_REGISTER_POINT_STRUCT(crisp::Point,
  (float, x, x)(float, y, y)(float, z, z)(float, intensity, intensity)
  (std::uint16_t, laser, laser)(std::uint16_t, beam, beam)(double, time, time))
// clang-format on
