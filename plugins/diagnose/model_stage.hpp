// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "pipeline/data/findings.hpp"
#include "pipeline/data/oriented_plate.hpp"
#include "pipeline/estimate/collected.hpp"
#include "pipeline/stage/context.hpp"
#include "pipeline/stage/description.hpp"
#include "plugins/diagnose/diagnosis.hpp"

namespace crisp {

/// Says what the model of the sensor lacks, and extends it.
class DiagnoseModelStage final : public Stage {
 public:
  static void describe(StageDescription<DiagnoseModelStage>& d);
  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  DiagnosisSettings settings_;
  std::optional<std::filesystem::path> folder_;
  double noise_ = SurfelSettings{}.noise;
  OrientedPlate oriented_;
  Collected collected_;
  std::shared_ptr<const Calibration> start_;
  Findings all_;  // what other diagnoses said before
};

}  // namespace crisp
