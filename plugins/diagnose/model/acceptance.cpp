// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/acceptance.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "plugins/diagnose/model/residual_variance.hpp"
#include "plugins/diagnose/model/significance.hpp"

namespace crisp::diagnose {
namespace {

/// Refits the model to the accepted hypotheses.
void refit_accepted(Diagnosis& diagnosis, const AcceptanceFits& fits, const TermRegistry& terms) {
  std::vector<Candidate> kept;
  for (const Hypothesis& hypothesis : diagnosis.hypotheses) {
    if (hypothesis.accepted) kept.push_back(hypothesis.candidate);
  }
  if (kept.empty()) {
    diagnosis.after = diagnosis.before;  // a fit from another start would differ by its tolerance
    return;
  }
  const Calibration found = diagnosis.after.outcome.model.calibration();
  diagnosis.after = fits.refit(with_terms(found, with_values_of(found, kept), terms));
}

/// Rules 2 to 4, for the hypotheses that are accepted so far.
void judge(Diagnosis& diagnosis, const CrossValidator::Score& plain, const AcceptanceFits& fits,
           const TermRegistry& terms, const DiagnosisSettings& settings) {
  std::vector<Hypothesis>& all = diagnosis.hypotheses;
  accept_if_it_generalizes(all, plain, diagnosis.after.outcome.model.calibration(), fits.held_out, terms);
  if (!std::ranges::all_of(all, &Hypothesis::accepted)) refit_accepted(diagnosis, fits, terms);
  while (reject_insignificant(all, diagnosis.after.outcome, terms, settings.selection.p_value))
    refit_accepted(diagnosis, fits, terms);
  const double noise = settings.refinement.surfels.noise;
  while (reject_if_residual_exceeds(all, fits.compare(diagnosis.after), noise))
    refit_accepted(diagnosis, fits, terms);
}

/// Accepts effects that surfaces resemble, if they explain all that is left: surfaces resemble no cause that
/// well.
///
/// @param with  the diagnosis in which no effect was rejected for that reason, judged
/// @return      whether they are accepted
bool explains_the_rest(Diagnosis& with, const std::vector<std::size_t>& small, double p_value,
                       double smallest) {
  if (!(p_value > smallest)) return false;
  bool has_accepted = false;
  for (const std::size_t one : small) {
    Hypothesis& hypothesis = with.hypotheses[one];
    if (!hypothesis.accepted) continue;
    has_accepted = true;
    hypothesis.decide(
        {.name = "goodness of fit with it", .threshold = smallest, .p_value = p_value, .passed = true}, {});
  }
  return has_accepted;
}

}  // namespace

void accept_or_reject(Diagnosis& diagnosis, const CrossValidator::Score& plain, const AcceptanceFits& fits,
                      const TermRegistry& terms, const DiagnosisSettings& settings) {
  const double smallest = settings.selection.p_value;
  Diagnosis with = diagnosis;
  reject_scene_artifacts(diagnosis.hypotheses);
  std::vector<std::size_t> small;
  for (std::size_t one = 0; one < diagnosis.hypotheses.size(); ++one) {
    if (!diagnosis.hypotheses[one].accepted) small.push_back(one);
  }
  // Where even the whole extended model leaves something, they do not explain all.
  const bool may_explain = !small.empty() && fits.compare(with.after).p_value > smallest;
  judge(diagnosis, plain, fits, terms, settings);
  if (may_explain && !(fits.compare(diagnosis.after).p_value > smallest)) {
    judge(with, plain, fits, terms, settings);
    if (explains_the_rest(with, small, fits.compare(with.after).p_value, smallest))
      diagnosis = std::move(with);
  }
}

}  // namespace crisp::diagnose
