// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <random>
#include <string>
#include <vector>

namespace independent {

/// The plate's angle over time, an integral of a smooth angular rate.
class PlateMotion {
 public:
  /// @param rate  angular rate [rad/s], smooth, over time [s]
  PlateMotion(const std::function<double(double)>& rate, double begin, double end);

  double angle(double time) const;  ///< [rad], counter-clockwise seen from +z
  double range() const;             ///< largest less smallest angle [rad]
  double slowest() const;           ///< of the rates' sizes [rad/s]
  double fastest() const;

 private:
  double begin_;
  std::vector<double> angles_, rates_;  // at the nodes of a grid
};

/// Draws a motion by name: varied, reversal, stop_and_go, ripple or constant.
///
/// A motion that covers less than 1.25 turns (reversal: 0.75) is drawn again, up to 100 times.
PlateMotion draw_motion(const std::string& name, double duration, std::mt19937_64 engine);

}  // namespace independent
