// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <crisp/measure.hpp>
#include <crisp/rig.hpp>

#include "pipeline/estimate/surfel_refinement.hpp"
#include "plugins/calibrate/rqe_calibration.hpp"

namespace crisp {

/// Settings for calibrating again under another assumption on the rig.
struct HypothesisSettings {
  const TermRegistry* terms = nullptr;
  Measure* measure = nullptr;
  RefinementSettings refinement;
  std::function<bool()> interrupted = [] { return false; };
  Reporter report;
};

/// Mounts that are off by little, as caveats: where `mount.mirror_zero` is clearly not 0 once it is free.
///
/// @param model  a refined one
std::vector<std::string> check_mounts(const SensorModel& model, const Sample& sample, const Rig& rig,
                                      const HypothesisSettings& settings);

/// Wrong counts a revolution, as a caveat: the scene repeats clearly better after another angle of the plate,
/// or a little better, and with such counts a calibration fits with clearly more beams.
std::optional<std::string> check_counts(const Sample& sample, const Rig& rig,
                                        const HypothesisSettings& settings);

/// Which mistake in the rig explains that a calibration does not fit, as a caveat: the encoder's direction,
/// or a mount of all lasers or one that is off by 45, 90 or 180 degrees, where a calibration with it right
/// fits and agrees with the nominal values.
///
/// Takes some calibrations' time, with a share of the beams each.
std::optional<std::string> find_rig_error(const Sample& sample, const Rig& rig,
                                          const HypothesisSettings& settings);

}  // namespace crisp
