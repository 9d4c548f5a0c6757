// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/data/oriented_plate.hpp"

#include <algorithm>
#include <functional>
#include <utility>

namespace crisp::data {

PlateTrajectory reversed(const PlateTrajectory& plate) {
  std::vector<double> angles(plate.size());
  std::ranges::transform(plate.angles(), angles.begin(), std::negate<>());
  return plate.with_angles(std::move(angles));
}

std::shared_ptr<const PlateTrajectory> OrientedPlate::operator()(std::shared_ptr<const PlateTrajectory> plate,
                                                                 const Calibration* calibration,
                                                                 const Rig& rig) {
  const bool reverses = rig.plate.direction == CountDirection::automatic && calibration &&
                        calibration->direction == CountDirection::clockwise;
  if (!reverses || !plate) return plate;
  if (given_ != plate) {
    reversed_ = std::make_shared<const PlateTrajectory>(reversed(*plate));
    given_ = std::move(plate);
  }
  return reversed_;
}

}  // namespace crisp::data
