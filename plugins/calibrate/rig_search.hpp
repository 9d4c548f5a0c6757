// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pipeline/data/rig.hpp"
#include "plugins/calibrate/rqe_calibration.hpp"

namespace crisp {

/// The range with those of τ and α around the start, and what the rig knows better: three standard
/// deviations.
SearchRange search_range_around(const SensorModel& start, const Rig& rig, SearchRange range);

/// The same with each λ within 20° of the start, too.
SearchRange search_range_with_lambda(const SensorModel& start, const Rig& rig, const SearchRange& given);

/// The crispest cloud near what the rig says; or away from it, where that shows that the rig is wrong.
///
/// Each τ and α is looked for within its range around the start, and whatever has a standard deviation in the
/// rig within three of them; other λ around the circle. A λ that is elsewhere than where the rig has it is
/// looked for near the start as well, which counts if a refinement from there fits. If the crispest cloud
/// lies at the end of a range, or the rig gives such standard deviations, and a refinement does not fit, it
/// is looked for anywhere. That one counts if it is clearly crisper and
///   - a usual mistake in the rig explains it (see check_with_rig()), or
///   - clearly more beams lie on flat surfaces once both are refined: an entropy falls as well when a wrong
///     calibration folds the scene into less room, as lasers that see one side only make it do.
///
/// @param start     where to start
/// @param settings  `in_plane.range` says how far τ and α may be from the start
/// @throws Error    as calibrate_by_rqe()
Outcome search_around_rig(const SensorModel& start, const Sample& sample, Measure& measure,
                          RqeCalibrationSettings settings, const Rig& rig, const Reporter& report);

}  // namespace crisp
