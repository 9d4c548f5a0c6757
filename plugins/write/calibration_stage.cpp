// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/calibration_stage.hpp"

#include "pipeline/files/calibration_file.hpp"

namespace crisp {

void WriteCalibrationStage::describe(StageDescription<WriteCalibrationStage>& d) {
  d.name("write.calibration").summary("writes the calibration as YAML");
  d.details(
      "What the stages above doubted is in the file, too: calibrate.load then does not trust it, either.");
  d.takes<Calibration>();
  d.option("file", &WriteCalibrationStage::file_, "where to write it").writes().required();
}

void WriteCalibrationStage::process(const Inputs& in, Outputs&, Context&) { last_ = in.share<Calibration>(); }

void WriteCalibrationStage::finish(Outputs&, Context& context) {
  if (!last_) throw Error("no calibration came, so none was written");
  Calibration calibration = *last_;
  calibration.doubts = context.doubts_above();
  calibration.provenance["crisp"] = CRISP_VERSION;
  write_calibration(file_, calibration);
  context.wrote(file_);
}

}  // namespace crisp
