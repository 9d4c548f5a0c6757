// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "pipeline/data/findings.hpp"
#include "pipeline/estimate/collected.hpp"
#include "pipeline/stage/context.hpp"
#include "pipeline/stage/description.hpp"

namespace crisp {

/// `diagnose.encoder`: finds where the encoder slipped, and corrects the plate's angles.
class DiagnoseEncoderStage final : public Stage {
 public:
  static void describe(StageDescription<DiagnoseEncoderStage>& d);

  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  using Batch = std::pair<std::shared_ptr<const PlateTrajectory>, std::shared_ptr<const Measurements>>;

  bool correct_ = true;
  Collected collected_;
  std::vector<Batch> batches_;
  Findings findings_;
};

}  // namespace crisp
