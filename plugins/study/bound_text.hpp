// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "plugins/study/refinement_accuracy.hpp"
#include "plugins/study/scene_bound.hpp"

namespace crisp::study {

/// A bound for people: the least standard errors in mm, degrees and ms, those that calibrate.refine reaches,
/// if that was tried, and what the recording leaves open.
std::string bound_text(const SceneBound& bound, const std::optional<RefinementAccuracy>& refinement = {});

/// A line a parameter: "parameter,unit,std_error,refined_std_error,known_instead", SI. An error is empty
/// where the parameter is unobservable, or none is known; the last field is the combination that is known in
/// place of an unobservable parameter, if there is one.
std::string bound_csv(const SceneBound& bound, const std::optional<RefinementAccuracy>& refinement = {});

}  // namespace crisp::study
