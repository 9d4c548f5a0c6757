// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include <crisp/plate_trajectory.hpp>
#include <crisp/rig.hpp>

namespace crisp::data {

/// The same readings of an encoder that counts the other way: φ → −φ.
PlateTrajectory reversed(const PlateTrajectory& plate);

/// Applies a calibration's encoder direction to a trajectory. Where the rig leaves the direction to the
/// calibration (`direction: auto`), clock stages read counts as counter-clockwise; a calibration for
/// clockwise counts gets the trajectory reversed. In all other cases the trajectory passes unchanged.
class OrientedPlate {
 public:
  /// @param calibration  null: the rig's nominal values
  std::shared_ptr<const PlateTrajectory> operator()(std::shared_ptr<const PlateTrajectory> plate,
                                                    const Calibration* calibration, const Rig& rig);

 private:
  std::shared_ptr<const PlateTrajectory> given_;  ///< of which `reversed_` was made
  std::shared_ptr<const PlateTrajectory> reversed_;
};

}  // namespace crisp::data
