// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "plugins/study/scene_bound.hpp"

namespace crisp {

/// A bound for people: the least standard errors in mm, degrees and ms, and what the recording leaves open.
std::string bound_text(const SceneBound& bound);

/// A line a parameter: "parameter,unit,std_error,known_instead", SI. The error of what is unobservable is
/// empty; the last field is then the combination that is known all the same, if there is one.
std::string bound_csv(const SceneBound& bound);

}  // namespace crisp
