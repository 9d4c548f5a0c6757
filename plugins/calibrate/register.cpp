// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/register.hpp"

#include "plugins/calibrate/load_stage.hpp"

namespace crisp {

void register_calibrate(Registrar& registrar) { registrar.stage<LoadCalibrationStage>(); }

}  // namespace crisp
