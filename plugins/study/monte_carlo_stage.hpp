// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include <crisp/context.hpp>
#include <crisp/stage.hpp>

#include "grabbers/simulate/scenario.hpp"
#include "plugins/study/monte_carlo.hpp"
#include "plugins/study/part_file.hpp"

namespace crisp::study {

/// `study.monte_carlo`: makes Table 1 of the paper anew, from simulated recordings.
class MonteCarloStage final : public Stage {
 public:
  MonteCarloStage() { settings_.runs = 1500; }
  static void describe(StageDescription<MonteCarloStage>& d);

  void check(const RunSettings& run) const override;
  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  // Target of the options.
  TrialSettings& trial() { return settings_.trial; }
  simulate::MotionSettings& motion() { return settings_.trial.motion; }
  simulate::NominalErrors& start() { return settings_.trial.start; }

  /// Has the lasers scatter as real ones were measured to, if any are named.
  void use_realism(TrialSettings& trial, Context& context) const;
  /// @throws Error if one of the requested effects is unknown, or applies to no device
  void check_effects(const RunSettings& run) const;
  /// Applies the requested effects to the simulated lasers. The estimators do not know them.
  void use_effects(TrialSettings& trial, const RunSettings& run) const;

  MonteCarloSettings settings_;
  simulate::SceneChoice scene_{.name = "paper", .file = {}};
  simulate::RealismChoice realism_;
  OptionGroups effects_;
  std::vector<double> sigma_ = {0.5, 0.1};
  std::filesystem::path runs_file_;
  std::filesystem::path table_file_;
  StudyPart part_;
  StudyExtent extent_;
  std::vector<MonteCarloTrial> trials_;
};

}  // namespace crisp::study
