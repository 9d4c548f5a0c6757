// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/register.hpp"

#include "plugins/write/calibration_stage.hpp"
#include "plugins/write/cloud_file_stage.hpp"
#include "plugins/write/clouds_stage.hpp"
#include "plugins/write/findings_stage.hpp"
#include "plugins/write/las_writer.hpp"
#include "plugins/write/measurements_stage.hpp"
#include "plugins/write/pcd_stage.hpp"
#include "plugins/write/picture/picture_stage.hpp"
#include "plugins/write/ply_writer.hpp"
#include "plugins/write/trajectory_stage.hpp"

namespace crisp::write {

void register_write(Registrar& registrar) {
  registrar.stage<WriteCalibrationStage>();
  registrar.stage<WriteCloudsStage>();
  registrar.stage<WriteFindingsStage>();
  registrar.stage<CloudFileStage<LasWriter>>();
  registrar.stage<WriteMeasurementsStage>();
  registrar.stage<WritePcdStage>();
  registrar.stage<WritePictureStage>();
  registrar.stage<CloudFileStage<PlyWriter>>();
  registrar.stage<WriteTrajectoryStage>();
  registrar.inspector(calibration_inspector());
}

}  // namespace crisp::write
