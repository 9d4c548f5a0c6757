// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>

#include <crisp/cloud.hpp>
#include <crisp/measurements.hpp>
#include <crisp/plate_trajectory.hpp>
#include <crisp/sensor_model.hpp>

namespace crisp {

/// A cloud of placed beams.
struct Deskewed {
  std::shared_ptr<Cloud> cloud;  ///< [m] in the base's frame, in the order of the measurements
  std::size_t outside = 0;       ///< beams fired when the plate's angle is unknown: left out
};

/// Places every beam where the plate was when that beam was fired: equations (1) to (3) of Sheehan, Harrison
/// and Newman, and the terms that `model` adds to them.
///
/// @param beams  n measurements: range [m], mirror angle [rad], hub time [s since the epoch], laser
/// @param plate  φ(t) [rad] on the hub's clock, with the same epoch
/// @param known  what is kept of one scan for the next
/// @param into   what becomes the cloud: nobody else holds it; its memory is used, not what it held
/// @return the cloud in the base's frame [m], in the order of the measurements
/// @throws Error if `beams` names a laser that `model` does not have, or the epochs differ
Deskewed deskew(const Measurements& beams, const PlateTrajectory& plate, const SensorModel& model,
                MirrorAngleCache& known, std::shared_ptr<Cloud> into = std::make_shared<Cloud>());

}  // namespace crisp
