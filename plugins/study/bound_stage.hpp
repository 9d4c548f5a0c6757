// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>

#include <crisp/context.hpp>
#include <crisp/stage.hpp>

#include "plugins/study/planned_recording.hpp"
#include "plugins/study/refinement_accuracy.hpp"
#include "plugins/study/scene_bound.hpp"

namespace crisp::study {

/// `study.bound`: computes the Cramér-Rao bound of the scanner's parameters for a planned recording.
class BoundStage final : public Stage {
 public:
  static void describe(StageDescription<BoundStage>& d);

  void check(const RunSettings& run) const override;
  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  void report(const PlannedRecording::Prepared& planned, Context& context) const;

  PlannedRecording planned_;
  BeamChoice beams_ = BeamChoice::kAll;
  bool refine_ = true;
  std::filesystem::path file_;
  SceneBound bound_;
  std::optional<RefinementAccuracy> refinement_;
};

}  // namespace crisp::study
