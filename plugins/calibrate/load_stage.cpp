// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/load_stage.hpp"

#include <algorithm>

#include "pipeline/files/calibration_file.hpp"
#include "pipeline/model/term_faults.hpp"
#include "pipeline/stage/registry.hpp"

namespace crisp {

Calibration ordered_as(const Rig& rig, Calibration calibration) {
  std::vector<LaserCalibration> ordered;
  for (const auto& laser : rig.lasers) {
    const LaserCalibration* found = calibration.find(laser.name);
    if (!found) {
      throw Error("the calibration has no laser '" + laser.name + "', which the rig has",
                  "use the calibration of this rig, or give the lasers the same names in both");
    }
    ordered.push_back(*found);
  }
  calibration.lasers = std::move(ordered);
  return calibration;
}

void LoadCalibrationStage::describe(StageDescription<LoadCalibrationStage>& d) {
  d.name("calibrate.load").summary("gives a calibration that was made before");
  d.gives<Calibration>();
  d.option("file", &LoadCalibrationStage::file_, "the calibration's YAML file").required();
}

void LoadCalibrationStage::process(const Inputs&, Outputs& out, Context& context) {
  if (!std::filesystem::exists(file_)) {
    throw Error("there is no calibration " + file_.string(), "calibrate first, or name another file");
  }
  const Calibration read = read_calibration(file_, judge_by(context.run().registrar->get<TermRegistry>()));
  context.reads(file_);
  Calibration calibration = ordered_as(context.rig(), read);
  if (read.lasers.size() > calibration.lasers.size()) {
    context.warn("the calibration has lasers that the rig does not have; they are not used");
  }
  out.give(std::move(calibration));
}

}  // namespace crisp
