// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include <crisp/context.hpp>
#include <crisp/stage.hpp>

#include "grabbers/simulate/scenario.hpp"
#include "plugins/study/basin.hpp"
#include "plugins/study/part_file.hpp"

namespace crisp::study {

/// `study.basin`: whether calibrations end in the same optimum from wherever they start, or add a caveat.
class BasinStage final : public Stage {
 public:
  BasinStage();
  static void describe(StageDescription<BasinStage>& d);
  void check(const RunSettings& run) const override;
  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  TrialSettings& trial() { return settings_.trial; }
  simulate::MotionSettings& motion() { return settings_.trial.motion; }

  BasinSettings settings_;
  simulate::SceneChoice scene_{.name = "paper", .file = {}};
  std::filesystem::path file_;
  StudyPart part_;
  StudyExtent extent_;  ///< recordings
  std::vector<BasinRecording> recordings_;
};

}  // namespace crisp::study
