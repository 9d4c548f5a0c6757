// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/report/register.hpp"

#include "plugins/report/folder_stage.hpp"
#include "plugins/report/report_stage.hpp"
#include "plugins/report/run_inspector.hpp"

namespace crisp::report {

void register_report(Registrar& registrar) {
  registrar.stage<WriteReportStage>();
  registrar.stage<FolderReportStage>();
  registrar.inspector(run_inspector());
}

}  // namespace crisp::report
