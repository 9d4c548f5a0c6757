// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/register.hpp"

#include "plugins/diagnose/clocks/clocks_stage.hpp"
#include "plugins/diagnose/clocks/encoder_stage.hpp"
#include "plugins/diagnose/model/model_stage.hpp"
#include "plugins/diagnose/noise/noise_model_stage.hpp"
#include "plugins/diagnose/noise/noise_stage.hpp"
#include "plugins/diagnose/report/crispness_stage.hpp"
#include "plugins/diagnose/report/findings_inspector.hpp"

namespace crisp::diagnose {

void register_diagnose(Registrar& registrar) {
  registrar.stage<CrispnessStage>();
  registrar.stage<DiagnoseEncoderStage>();
  registrar.stage<DiagnoseModelStage>();
  registrar.stage<DiagnoseNoiseStage>();
  registrar.stage<DiagnoseNoiseModelStage>();
  registrar.stage<DiagnoseClocksStage>();
  registrar.inspector(findings_inspector());
}

}  // namespace crisp::diagnose
