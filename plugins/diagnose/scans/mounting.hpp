// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "plugins/diagnose/scans/passes.hpp"

namespace crisp::diagnose {

/// Beam directions of a laser whose scan plane contains the tilt axis.
struct FanGeometry {
  double first = 0;  ///< [rad] θ of the first beam: 90° points away from the axis
  double step = 0;   ///< [rad]
};

/// Mounting parameters that all beams of the laser share.
enum MountingParameter : std::uint8_t {
  kAlongBeam,    ///< [m] offset of the optical centre from the axis, along the middle beam
  kAlongNormal,  ///< [m] offset along the fan's normal, in the direction of growing angle
  kRangeOffset,  ///< [m] correction to be added to the ranges
};
inline constexpr std::size_t kMountingParameters = 3;
using MountingValues = std::array<double, kMountingParameters>;

/// A window of neighbouring scans and beams that measure one flat surface.
struct FlatWindow {
  struct Sight {
    double angle = 0;   ///< [rad] of the actuator
    double mirror = 0;  ///< [rad] θ
    double range = 0;   ///< [m]
    std::size_t beam = 0;
  };
  std::vector<Sight> sights;
};

/// Cuts the sweep into windows of about `side` [rad] in both directions, and keeps the flat ones, judged by
/// each beam's noise between scans. Each window has its own optical centre in this test, so that the
/// selection does not favour any value of the mounting.
std::vector<FlatWindow> flat_windows(const Pass& pass, const FanGeometry& fan, double side);

/// Joint estimate of the mounting parameters.
struct MountingFit {
  MountingValues values{};
  MountingValues std_errors{};  ///< bootstrap over windows
  double rms = 0;               ///< [m] range residuals
  std::size_t windows = 0;
  std::size_t beams = 0;
};

/// Estimates the free mounting parameters by least squares in the ranges, with a plane per window eliminated
/// (variable projection). Other parameters stay at `start`.
MountingFit fit_mounting(const std::vector<FlatWindow>& windows, const MountingValues& start,
                         const std::vector<MountingParameter>& free, std::uint64_t seed);

/// Injects an error of one parameter: the ranges become those along the beams to the windows' planes.
std::vector<FlatWindow> with_injected(const std::vector<FlatWindow>& windows, MountingParameter parameter,
                                      double by);

}  // namespace crisp::diagnose
