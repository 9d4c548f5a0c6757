// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <crisp/cloud.hpp>
#include <crisp/measurements.hpp>

namespace crisp::filter {

/// From the smallest to the largest value that is kept, both included; empty: no limit.
using Limits = std::vector<double>;

/// @param name of the option, for the error
/// @throws Error if the first is above the second, or there is only one
void check_limits(const Limits& limits, const std::string& name);

/// Limits of the kept points, in the plate's frame.
struct CropLimits {
  Limits x;         ///< [m]
  Limits y;         ///< [m]
  Limits z;         ///< [m]
  Limits distance;  ///< [m] from the plate's centre
};

/// The points within all limits, in their order. A value that is not a number is outside of every limit.
Cloud crop(const Cloud& cloud, const CropLimits& limits);

/// The measurements that are kept.
struct RangeLimits {
  Limits range;                  ///< [m]
  Limits mirror_angle;           ///< [rad]
  Limits remission;              ///< device's units
  std::vector<unsigned> lasers;  ///< indices in the rig; empty: all
};

/// The measurements within all limits, in their order.
Measurements within(const Measurements& beams, const RangeLimits& limits);

}  // namespace crisp::filter
