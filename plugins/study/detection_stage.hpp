// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include <crisp/context.hpp>
#include <crisp/stage.hpp>

#include "plugins/study/effect_detection.hpp"
#include "plugins/study/planned_recording.hpp"

namespace crisp::study {

/// `study.detection`: computes from which size on a planned recording shows each effect, and resolves its
/// cause.
class DetectionStage final : public Stage {
 public:
  static void describe(StageDescription<DetectionStage>& d);

  void check(const RunSettings& run) const override;
  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  PlannedRecording planned_;
  std::filesystem::path file_;
  EffectDetection detection_;
};

}  // namespace crisp::study
