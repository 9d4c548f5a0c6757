// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include <crisp/context.hpp>
#include <crisp/findings.hpp>
#include <crisp/stage.hpp>

#include "pipeline/estimate/measurement_buffer.hpp"

namespace crisp::diagnose {

/// Stage `diagnose.encoder`: detects slips of the encoder, and corrects the plate's angles.
class DiagnoseEncoderStage final : public Stage {
 public:
  static void describe(StageDescription<DiagnoseEncoderStage>& d);

  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  using Batch = std::pair<std::shared_ptr<const PlateTrajectory>, std::shared_ptr<const Measurements>>;

  bool correct_ = true;
  estimate::MeasurementBuffer collected_;
  std::vector<Batch> batches_;
  Findings findings_;
};

}  // namespace crisp::diagnose
