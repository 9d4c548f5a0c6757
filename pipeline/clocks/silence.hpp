// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace crisp {

/// How long a device was silent between two of its items: by the hub's clock, or by the device's own where
/// the hub's clock was set forward in between, or items waited on their way.
///
/// @param hub_s     [s] between the receipts
/// @param device_s  [s] between the stamps; not positive where the stamps are of no use
inline double silence_between(double hub_s, double device_s) {
  constexpr double kSet = 0.5;  // [s] far above the delays of a network
  return device_s > 0 && hub_s - device_s > kSet ? device_s : hub_s;
}

}  // namespace crisp
