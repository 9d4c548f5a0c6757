// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <crisp/calibration.hpp>
#include <crisp/measurements.hpp>
#include <crisp/rig.hpp>

#include "pipeline/estimate/surfel_refinement.hpp"

namespace crisp::calibrate {

/// Caveats of a refined calibration's fit: convergence, agreement of views, misfit of the surfaces against
/// the ranges' noise, consistency with the rig, and RQE.
///
/// RQE counts only where the views are not known to agree, and the start's RQE only if the refinement ended
/// near it: an entropy decreases as well where a wrong calibration folds the scene into less room.
///
/// @param refined      of `start`
/// @param calibration  the refined one, with its quality: "rqe_before", "rqe_unrefined", "rqe_after" [nat]
/// @param noise        [m] standard deviation of a range
std::vector<std::string> check_fit(const estimate::Refinement& refined, const Calibration& calibration,
                                   const Calibration& start, const Rig& rig, double noise);

/// Caveats of devices without any beam, and of lasers that were heard for less than half of the recording:
/// their own values rest on little, and the others' λ and η refer to the first laser's. A laser without an
/// address or topic of its own is one of many in a device, and may have seen nothing.
std::vector<std::string> check_silence(const Measurements& beams, const Rig& rig);

/// The least share of beams on which two views agree. @param refined  with views
double least_agreement(const estimate::Refinement& refined);

/// Whether views are known to agree well, so that no other judge is needed.
bool agrees_well(const estimate::Refinement& refined);

/// [m] How far beams miss their surfaces (RMS).
double misfit_of(const estimate::Refinement& refined, double noise);

/// The same in units of what ranges scatter by from neighbour to neighbour, or else of their stated noise.
double relative_misfit(const estimate::Refinement& refined, double noise);

/// Limit of relative_misfit(). The surfaces' own roughness makes up to 1.4: see SurfelSettings::max_excess.
inline constexpr double kPoorFit = 1.5;

}  // namespace crisp::calibrate
