// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/register.hpp"

#include "plugins/calibrate/load_stage.hpp"
#include "plugins/calibrate/refine_stage.hpp"
#include "plugins/calibrate/rqe_stage.hpp"

namespace crisp::calibrate {

void register_calibrate(Registrar& registrar) {
  registrar.stage<LoadCalibrationStage>();
  registrar.stage<RqeStage>();
  registrar.stage<RefineStage>();
}

}  // namespace crisp::calibrate
