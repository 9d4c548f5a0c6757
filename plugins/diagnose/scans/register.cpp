// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/scans/register.hpp"

#include "plugins/diagnose/scans/mounting_stage.hpp"
#include "plugins/diagnose/scans/passes_stage.hpp"
#include "plugins/diagnose/scans/stationary_stage.hpp"
#include "plugins/diagnose/scans/sweep_stage.hpp"

namespace crisp::diagnose {

void register_scans(Registrar& registrar) {
  registrar.stage<DiagnoseStationaryStage>();
  registrar.stage<DiagnoseSweepStage>();
  registrar.stage<DiagnosePassesStage>();
  registrar.stage<DiagnoseMountingStage>();
}

}  // namespace crisp::diagnose
