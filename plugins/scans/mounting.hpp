// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "plugins/scans/passes.hpp"

namespace crisp {

/// A laser on a tilt axis, beam by beam: all that equation (2) asks of it but where the optical centre lies.
struct FanGeometry {
  double first = 0;  ///< [rad] θ of the first beam: 90° points away from the axis
  double step = 0;   ///< [rad]
};

/// What can be off in a laser on an axis, common to all of its beams.
enum MountingParameter : std::uint8_t {
  kAlongBeam,    ///< [m] of the optical centre from the axis, along the middle beam
  kAlongNormal,  ///< [m] along the fan's normal, in the sense of the angle
  kRangeOffset,  ///< [m] that is to be added to the ranges
};
inline constexpr std::size_t kMountingParameters = 3;
using MountingValues = std::array<double, kMountingParameters>;

/// A window of neighbouring scans and beams, in which the ranges are those of one flat surface.
struct FlatWindow {
  struct Sight {
    double angle = 0;   ///< [rad] of the actuator
    double mirror = 0;  ///< [rad] θ
    double range = 0;   ///< [m]
    std::size_t beam = 0;
  };
  std::vector<Sight> sights;
};

/// Cuts the sweep into windows of about `side` [rad] both ways and keeps those that are flat by the noise
/// of each beam from scan to scan. Each is allowed an offset of the optical centre of its own, so that no
/// value of what is to be found is preferred by the choice.
std::vector<FlatWindow> flat_windows(const Pass& pass, const FanGeometry& fan, double side);

/// What all windows together say.
struct MountingFit {
  MountingValues values{};
  MountingValues std_errors{};  ///< by a bootstrap over windows
  double rms = 0;               ///< [m] of the ranges
  std::size_t windows = 0;
  std::size_t beams = 0;
};

/// Least squares in the ranges, each window with a plane of its own (projected out). What is not free stays
/// at `start`.
MountingFit fit_mounting(const std::vector<FlatWindow>& windows, const MountingValues& start,
                         const std::vector<MountingParameter>& free, std::uint64_t seed);

/// The windows as if a parameter were off by that much: ranges along the beams, to the windows' planes.
std::vector<FlatWindow> with_put_in(const std::vector<FlatWindow>& windows, MountingParameter parameter,
                                    double by);

}  // namespace crisp
