// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "pipeline/estimate/surfel_refinement.hpp"
#include "plugins/diagnose/departure.hpp"
#include "plugins/diagnose/profiles.hpp"
#include "plugins/diagnose/survey.hpp"

namespace crisp {

struct Diagnosis {
  Refinement before;  ///< without any terms
  Refinement after;   ///< with those that were accepted
  std::vector<Departure> departures;
  /// Of candidates with a form, by name, what else was tried. `after` counts on it.
  std::map<std::string, std::vector<Candidate::OtherForm>> other_forms;
  std::vector<Gain> gains;  ///< of all that were accepted, on turns that models are not fitted to
  std::vector<Limit> unobservable;
  std::vector<std::string> unshared;  ///< terms that were not looked for: recordings cannot share them
  std::size_t looks = 0;              ///< different things that were looked for
  bool settled = false;               ///< whether a last look at the extended model asked for nothing else
  SideBySide left_before;
  SideBySide left_after;
};

/// Told what is done next, and how much is done by then (about: nobody knows how many rounds it takes).
using DiagnosisReporter = std::function<void(double fraction, const std::string& what)>;

/// Looks for what the model of the sensor lacks: refines it, looks at all terms that could be added (score
/// tests), adds those that are needed, and so on until nothing is missing. What does not pay on held-out
/// turns of the plate is left out again, and so is what comes out as nothing without others that do not pay,
/// and a cause that takes less than what departs from the extended model all the same: it may be no more than
/// a part of that.
///
/// @param start   right to some centimetres and degrees
/// @param sample  all beams; need not be covered
/// @throws Error        as refine_by_surfels() does
/// @throws Interrupted  where `settings.interrupted` says so
Diagnosis diagnose(const SensorModel& start, const Sample& sample, const TermRegistry& terms,
                   const DiagnosisSettings& settings, const DiagnosisReporter& report = {});

}  // namespace crisp
