// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <crisp/rig.hpp>

#include "plugins/diagnose/model/diagnosis.hpp"

namespace crisp::diagnose {

/// Machine-readable findings of a diagnosis, in the order of selection.
///
/// @param terms  provide what makes causes resolvable that these data do not resolve
Findings findings_of(const Diagnosis& diagnosis, const Calibration& calibration, const TermRegistry& terms,
                     const SelectionSettings& settings, double noise);

/// Scope of a profile: a laser's name, or "scanner".
std::string scope_of(const Profile& profile, const Calibration& calibration);

/// One line of text: cause, size and p-value.
std::string headline(const Finding& finding);
std::string headline(const UnnamedFinding& finding);

/// A few lines of text, with Bayes factor, competing causes and gains.
std::string in_words(const Finding& finding);
std::string in_words(const UnnamedFinding& finding);
std::string in_words(const Diagnosis& diagnosis, const Findings& findings);

}  // namespace crisp::diagnose
