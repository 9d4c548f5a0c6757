// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace crisp::simulate {

/// Something becomes larger at an instant of the hub's time.
struct Step {
  double at = 0;  ///< [s]
  double by = 0;  ///< [s]

  double before(double hub_time) const { return hub_time >= at ? by : 0; }  ///< [s] what of it has come
};

/// A device's own clock against the hub's. Hub time is true time here [s since the recording's epoch].
struct DeviceClock {
  double start = 0;                 ///< [s] what it reads at hub time 0
  double skew = 0;                  ///< hub seconds a device second − 1, at hub time 0: as ClockMap has it
  double drift = 0;                 ///< [1/s] growth of the skew per second
  std::vector<double> resets = {};  ///< [s] hub times at which it starts again from zero; ascending
  Step step = {};                   ///< a jump of what it reads

  /// Device seconds since the last reset or, before any, since 0.
  double seconds(double hub_time) const;
  /// The same in whole microseconds as telegrams carry them: wraps at 2^32.
  std::uint32_t microseconds(double hub_time) const;
  /// Number of earlier resets.
  std::size_t resets_before(double hub_time) const;
};

}  // namespace crisp::simulate
