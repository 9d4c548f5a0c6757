// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include <crisp/clock_map.hpp>
#include <crisp/context.hpp>
#include <crisp/findings.hpp>
#include <crisp/stage.hpp>

#include "pipeline/data/oriented_plate.hpp"
#include "pipeline/estimate/measurement_buffer.hpp"
#include "plugins/diagnose/model/diagnosis.hpp"

namespace crisp::diagnose {

/// Stage diagnose.model: identifies terms that the sensor model lacks, and extends the calibration by them.
class DiagnoseModelStage final : public Stage {
 public:
  static void describe(StageDescription<DiagnoseModelStage>& d);
  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  DiagnosisSettings settings_;
  std::optional<std::filesystem::path> folder_;
  double noise_ = quality::SurfelSettings{}.noise;
  data::OrientedPlate oriented_;
  estimate::MeasurementBuffer collected_;
  std::shared_ptr<const Calibration> start_;
  std::map<std::string, ClockMap> clocks_;  // by device
  Findings all_;                            // including those of earlier stages
};

}  // namespace crisp::diagnose
