// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

#include <crisp/clock_map.hpp>
#include <crisp/plate_trajectory.hpp>
#include <crisp/rig.hpp>

#include "pipeline/estimate/outcome.hpp"

namespace crisp::estimate {

/// Adds to the covariance of each η what the clocks' own errors make of it: η_i is off by what the laser's
/// clock is early and the plate's is late, and the plate's error is common to all.
///
/// @param clocks  by device; those that are not there count as exact
void add_clock_errors(Outcome& outcome, const Rig& rig, const std::map<std::string, ClockMap>& clocks);

/// [rad] Standard deviation of the plate's angle at the time of a beam, by the steps of its encoder and by
/// the clocks' rates, as far as no η makes up for them.
double plate_angle_error(const PlateTrajectory& plate, const Rig& rig,
                         const std::map<std::string, ClockMap>& clocks);

}  // namespace crisp::estimate
