// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/pcd/register.hpp"

#include "grabbers/pcd/cloud_stage.hpp"
#include "grabbers/pcd/measurements_stage.hpp"
#include "grabbers/pcd/pcd_inspector.hpp"

namespace crisp::pcd_grabber {

void register_pcd(Registrar& registrar) {
  registrar.stage<GrabCloudStage>();
  registrar.stage<GrabMeasurementsStage>();
  registrar.inspector(pcd_inspector());
}

}  // namespace crisp::pcd_grabber
