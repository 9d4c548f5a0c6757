// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/acceptance.hpp"

#include <algorithm>

#include "plugins/diagnose/model/clock_lines.hpp"
#include "plugins/diagnose/model/residual_variance.hpp"
#include "plugins/diagnose/model/significance.hpp"

namespace crisp {
namespace {

/// Refits the model to the accepted hypotheses.
void refit_accepted(Diagnosis& diagnosis, const AcceptanceFits& fits) {
  std::vector<Candidate> kept;
  for (const Hypothesis& hypothesis : diagnosis.hypotheses) {
    if (hypothesis.accepted) kept.push_back(hypothesis.candidate);
  }
  const Calibration found = diagnosis.after.outcome.model.calibration();
  diagnosis.after = fits.refit(with_terms(found, with_values_of(found, kept)));
}

}  // namespace

void accept_or_reject(Diagnosis& diagnosis, const CrossValidator::Score& plain, const AcceptanceFits& fits,
                      const TermRegistry& terms, const DiagnosisSettings& settings, double middle) {
  std::vector<Hypothesis>& all = diagnosis.hypotheses;
  reject_scene_artifacts(all);
  accept_if_it_generalizes(all, plain, diagnosis.after.outcome.model.calibration(), fits.held_out);
  if (!std::ranges::all_of(all, &Hypothesis::accepted)) refit_accepted(diagnosis, fits);
  while (reject_insignificant(all, diagnosis.after.outcome, terms, settings.selection.p_value))
    refit_accepted(diagnosis, fits);
  const double noise = settings.refinement.surfels.noise;
  while (reject_if_residual_exceeds(all, fits.compare(diagnosis.after), noise))
    refit_accepted(diagnosis, fits);
  mark_clock_lines(all, diagnosis.after.outcome, settings.skew_errors, middle);
}

}  // namespace crisp
