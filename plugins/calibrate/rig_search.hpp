// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crisp/rig.hpp>

#include "plugins/calibrate/rqe_calibration.hpp"

namespace crisp::calibrate {

/// The range with those of τ and α around the start, and what the rig knows better: three standard
/// deviations.
estimate::ParameterPrior search_range_around(const SensorModel& start, const Rig& rig,
                                             estimate::ParameterPrior range);

/// The same with each λ within 20° of the start, too.
estimate::ParameterPrior search_range_with_lambda(const SensorModel& start, const Rig& rig,
                                                  const estimate::ParameterPrior& given);

/// Minimizes RQE near the rig's nominal values; or away from them, where that shows that the rig is wrong.
///
/// Each τ and α is searched within its range around the start, and whatever has a standard deviation in the
/// rig within three of them; other λ around the circle. A λ that ends away from the rig's is searched near
/// the start as well, which counts if a refinement from there fits. If the minimum lies at the end of a
/// range, or the rig gives such standard deviations, and a refinement does not fit, the search is global. Its
/// minimum counts if it is clearly lower and
///   - a usual mistake in the rig explains it (see check_with_rig()), or
///   - clearly more beams lie on flat surfaces once both are refined: an entropy decreases as well when a
///   wrong calibration folds the scene into less room, as for lasers that see one side only.
///
/// @param start     where to start
/// @param settings  `in_plane.range` limits the distance of τ and α from the start
/// @throws Error    as calibrate_by_rqe()
estimate::Outcome search_around_rig(const SensorModel& start, const estimate::Sample& sample,
                                    Measure& measure, RqeCalibrationSettings settings, const Rig& rig,
                                    const Reporter& report);

/// An outcome with the direction in which the encoder's readings were counted.
struct DirectedOutcome {
  estimate::Outcome outcome;
  CountDirection direction = CountDirection::counter_clockwise;
};

/// The same for a rig with `direction: auto`. A clockwise encoder gives the mirror image, unless the search
/// range holds only a local minimum of it. If the outcome neither fits nor is a mirror image, the search is
/// repeated with the readings reversed, which counts if the outcome then fits.
DirectedOutcome search_in_both_directions(const SensorModel& start, const estimate::Sample& sample,
                                          Measure& measure, const RqeCalibrationSettings& settings,
                                          const Rig& rig, const Reporter& report);

}  // namespace crisp::calibrate
