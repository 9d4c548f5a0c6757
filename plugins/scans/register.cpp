// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/scans/register.hpp"

#include "plugins/scans/mounting_stage.hpp"
#include "plugins/scans/passes_stage.hpp"
#include "plugins/scans/rest_stage.hpp"
#include "plugins/scans/sweep_stage.hpp"

namespace crisp {

void register_scans(Registrar& registrar) {
  registrar.stage<DiagnoseRestStage>();
  registrar.stage<DiagnoseSweepStage>();
  registrar.stage<DiagnosePassesStage>();
  registrar.stage<DiagnoseMountingStage>();
}

}  // namespace crisp
