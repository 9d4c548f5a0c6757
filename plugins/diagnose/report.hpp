// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "pipeline/data/rig.hpp"
#include "plugins/diagnose/diagnosis.hpp"

namespace crisp {

/// A diagnosis for programs: findings in the order in which they were taken into the model.
///
/// @param terms  say what would tell causes apart that these data cannot
Findings findings_of(const Diagnosis& diagnosis, const Calibration& calibration, const TermRegistry& terms,
                     const SelectionSettings& settings, double noise);

/// Of what a profile is: a laser's name, or "scanner".
std::string scope_of(const Profile& profile, const Calibration& calibration);

/// And for people: what was found, with its size and p-value, in a line.
std::string headline(const Finding& finding);
std::string headline(const UnnamedFinding& finding);

/// With what else is known of it, in a few lines.
std::string in_words(const Finding& finding);
std::string in_words(const UnnamedFinding& finding);
std::string in_words(const Diagnosis& diagnosis, const Findings& findings);

}  // namespace crisp
