// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace crisp {

/// One straight piece of a clock map, valid from `device_begin` to the next piece's.
struct ClockPiece {
  double device_begin = 0;    ///< [s] unwrapped device time at which the piece begins
  double hub_begin = 0;       ///< [s since the run's epoch] hub time there
  double rate = 1;            ///< hub seconds per device second; skew = rate − 1
  double rate_std_error = 0;  ///< standard error of the rate
};

/// device time → hub time of one device: continuous and piecewise linear between resets of the device.
struct ClockMap {
  std::string device;              ///< the rig's name of it, "laser1" or "plate"
  std::vector<ClockPiece> pieces;  ///< ascending in device_begin
  double device_end = 0;           ///< [s] unwrapped device time of the last stamp
  double skew_std_error = 0;       ///< standard error of the mean skew, as a ratio
  double std_error = 0;            ///< [s] standard error of the hub times, in the mean over the recording
  double residual_median = 0;      ///< [s] median delay of the stamps above the line
  double residual_95 = 0;          ///< [s] 95 % quantile of it
  std::size_t stamps = 0;          ///< pairs (device time, receipt time) that the map is fitted to

  /// @param device_time [s] unwrapped device time; outside the pieces the first or last is extended
  /// @return [s since the run's epoch]
  double to_hub(double device_time) const;
  /// Mean skew over all pieces, weighted by their duration up to device_end, in parts per million.
  double skew_ppm() const;
};

}  // namespace crisp
