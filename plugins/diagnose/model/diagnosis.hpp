// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "pipeline/estimate/surfel_refinement.hpp"
#include "plugins/diagnose/model/candidate_search.hpp"
#include "plugins/diagnose/model/hypothesis.hpp"
#include "plugins/diagnose/model/recording_proposals.hpp"
#include "plugins/diagnose/model/residual_profiles.hpp"

namespace crisp::diagnose {

/// Result of the diagnosis: refined models before and after extension, with hypotheses and residuals.
struct Diagnosis {
  estimate::Refinement before;  ///< without further terms
  estimate::Refinement after;   ///< with the accepted terms
  std::vector<Hypothesis> hypotheses;
  /// Evaluated forms of each candidate with a grid, by name. The covariance in `after` includes them.
  std::map<std::string, std::vector<Candidate::OtherForm>> other_forms;
  std::vector<Gain> gains;  ///< of all accepted terms on held-out turns
  std::vector<Limit> unobservable;
  std::vector<std::string> unshared;  ///< terms that were not tested: recordings cannot share them
  std::size_t tests = 0;              ///< number of different candidates tested
  bool settled = false;               ///< whether the last selection added nothing to the extended model
  /// Of what these data do not show, or do not resolve; none if there is nothing of the kind.
  std::vector<RecordingProposal> proposals;
  ProfileComparison left_before;
  ProfileComparison left_after;
};

/// Progress callback: next step and fraction done (approximate, since the number of rounds is unknown).
using DiagnosisReporter = std::function<void(double fraction, const std::string& what)>;

/// Diagnoses the sensor model: refines it, tests all candidate terms (score tests), adds the needed ones
/// (stepwise selection) and repeats until no candidate is significant. It then rejects terms that do not
/// generalize to held-out turns (cross-validation), or are not significant in the joint fit (Wald test). It
/// also rejects causes that explain less than the remaining systematic residual.
///
/// @param start   accurate to a few centimetres and degrees
/// @param sample  all beams; the encoder readings need not cover them all
/// @throws Error        as refine_by_surfels() does
/// @throws Interrupted  when `settings.interrupted` returns true
Diagnosis diagnose(const SensorModel& start, const estimate::Sample& sample, const TermRegistry& terms,
                   const DiagnosisSettings& settings, const DiagnosisReporter& report = {});

}  // namespace crisp::diagnose
