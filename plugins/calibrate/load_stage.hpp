// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include <crisp/calibration.hpp>
#include <crisp/context.hpp>
#include <crisp/rig.hpp>
#include <crisp/stage.hpp>

namespace crisp::calibrate {

/// The calibration with its lasers in the order of the rig; those that the rig does not have are left out.
/// @throws Error  if a laser of the rig has no calibration
Calibration ordered_as(const Rig& rig, Calibration calibration);

/// Loads a calibration from a file.
class LoadCalibrationStage final : public Stage {
 public:
  static void describe(StageDescription<LoadCalibrationStage>& d);
  void process(const Inputs& in, Outputs& out, Context& context) override;

 private:
  std::filesystem::path file_;
};

}  // namespace crisp::calibrate
