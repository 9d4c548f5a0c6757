// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>

#include <crisp/calibration.hpp>
#include <crisp/context.hpp>
#include <crisp/registrar.hpp>
#include <crisp/stage.hpp>

namespace crisp::write {

/// Writes the last calibration that it was given, when the run is over.
class WriteCalibrationStage final : public Stage {
 public:
  static void describe(StageDescription<WriteCalibrationStage>& d);
  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  std::filesystem::path file_;
  std::shared_ptr<const Calibration> last_;
};

/// Description of a calibration file for `crisp info`.
Inspector calibration_inspector();

}  // namespace crisp::write
