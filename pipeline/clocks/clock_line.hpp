// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

namespace crisp::clocks {

/// A pair of times: a device's time stamp of sending, and its delay until receipt by the hub's clock. Both
/// are relative to the first stamp of a run, which keeps all digits.
struct Stamp {
  double device = 0;  ///< [s] device time
  double lead = 0;    ///< [s] hub's receipt time − device time
};

/// The straight line lead = at_center + slope · (device − center): a clock without its delays.
struct ClockLine {
  double center = 0;     ///< [s] device time
  double at_center = 0;  ///< [s]
  double slope = 0;      ///< hub seconds gained a device second: the skew

  double lead(double device) const { return at_center + slope * (device - center); }
};

/// The skew beyond which no crystal goes; an edge between two stamps that are close can be any steep.
inline constexpr double kMaxSkew = 1e-3;

/// The line that lies below all stamps and passes as high as possible at `center`. With the mean of the
/// stamps' device times as `center` it is the line whose summed distance to them is least.
///
/// By the lower convex hull of the stamps (Zhang, Liu, Xia: Clock synchronization algorithms for network
/// measurements, INFOCOM 2002): the line is the hull's edge above or below which `center` lies. O(n).
///
/// @param stamps at least one, ascending in device time; equal times are allowed
/// @param center [s] device time, within the stamps' times
/// @return |slope| ≤ kMaxSkew
ClockLine line_by_convex_hull(std::span<const Stamp> stamps, double center);

/// Slope of the same edge of the hull, however steep; 0 for a single stamp.
double hull_slope(std::span<const Stamp> stamps, double center);

/// The errors of a line below stamps.
struct LineErrors {
  double bias = 0;       ///< [s] how far above the clock it lies on the average: no stamp has the least delay
  double at_center = 0;  ///< [s] standard error there, once that is taken out
  double slope = 0;      ///< standard error
};

/// Uncertainty of the line against the clock, estimated from the density of stamps near it: see
/// estimate_line_bias().
///
/// @param stamps  those that the line was fitted to
/// @param quantum [s] the resolution of the stamps
LineErrors errors_of_line(std::span<const Stamp> stamps, const ClockLine& line, double quantum = 1e-6);

}  // namespace crisp::clocks
