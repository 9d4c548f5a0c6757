// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/calibration_stage.hpp"

#include <crisp/calibration_file.hpp>

namespace crisp::write {

void WriteCalibrationStage::describe(StageDescription<WriteCalibrationStage>& d) {
  d.name("write.calibration").summary("writes the calibration as YAML");
  d.details(
      "The file holds the caveats of the stages above: calibrate.load then marks its result untrusted, too.");
  d.takes<Calibration>();
  d.option("file", &WriteCalibrationStage::file_, "output file, NAME.yaml").writes().required();
}

void WriteCalibrationStage::process(const Inputs& in, Outputs&, Context&) { last_ = in.share<Calibration>(); }

void WriteCalibrationStage::finish(Outputs&, Context& context) {
  if (!last_) throw Error("there was no calibration to write", "see what the stages above report");
  Calibration calibration = *last_;
  calibration.caveats = context.caveats_above();
  calibration.provenance["crisp"] = CRISP_VERSION;
  write_calibration(file_, calibration);
  context.wrote(file_);
}

}  // namespace crisp::write
