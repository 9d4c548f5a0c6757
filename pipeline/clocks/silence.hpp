// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

namespace crisp::clocks {

inline constexpr double kClockSet = 0.5;  ///< [s] by which a hub's clock is set: far above a network's delays

/// Whether receipts jump against the device's clock: the hub's clock was set, or items waited on their way.
///
/// @param hub_s     [s] between the receipts
/// @param device_s  [s] between the stamps; 0 where the clock stands still
inline bool is_receipt_jump(double hub_s, double device_s) {
  return device_s != 0 && std::abs(hub_s - device_s) > kClockSet;
}

/// How long a device was silent between two of its items: by the hub's clock, or by the device's own where
/// the hub's clock was set forward in between, or items waited on their way.
///
/// @param hub_s     [s] between the receipts
/// @param device_s  [s] between the stamps; not positive where the stamps are of no use
inline double silence_between(double hub_s, double device_s) {
  return device_s > 0 && hub_s - device_s > kClockSet ? device_s : hub_s;
}

}  // namespace crisp::clocks
