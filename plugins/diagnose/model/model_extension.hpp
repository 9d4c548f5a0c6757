// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "plugins/diagnose/model/diagnosis.hpp"
#include "plugins/diagnose/model/model_fits.hpp"

namespace crisp::diagnose {

/// Extends the model of `result.after` by the candidates that the recording needs, round by round, until the
/// selection adds nothing: sets its hypotheses, forms, limits and the extended model, which lacks full
/// standard errors.
void extend(Diagnosis& result, const ModelFits& fits, const TermRegistry& terms,
            const DiagnosisSettings& settings, const DiagnosisReporter& report);

}  // namespace crisp::diagnose
