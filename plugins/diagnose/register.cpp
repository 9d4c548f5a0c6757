// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/register.hpp"

#include "plugins/diagnose/crispness_stage.hpp"
#include "plugins/diagnose/encoder_stage.hpp"
#include "plugins/diagnose/findings_inspector.hpp"
#include "plugins/diagnose/model_stage.hpp"
#include "plugins/diagnose/noise_stage.hpp"
#include "plugins/diagnose/scatter_stage.hpp"
#include "plugins/diagnose/stamps_stage.hpp"

namespace crisp {

void register_diagnose(Registrar& registrar) {
  registrar.stage<CrispnessStage>();
  registrar.stage<DiagnoseEncoderStage>();
  registrar.stage<DiagnoseModelStage>();
  registrar.stage<DiagnoseNoiseStage>();
  registrar.stage<DiagnoseScatterStage>();
  registrar.stage<DiagnoseStampsStage>();
  registrar.inspector(findings_inspector());
}

}  // namespace crisp
