// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <crisp/context.hpp>
#include <crisp/stage.hpp>

#include "grabbers/simulate/effect_injection.hpp"

namespace crisp::simulate {

/// `simulate.inject`: a known change in scans that were recorded, to see what a measure answers.
class InjectStage final : public Stage {
 public:
  static void describe(StageDescription<InjectStage>& d);
  void check(const RunSettings& run) const override;
  void process(const Inputs& in, Outputs& out, Context& context) override;

 private:
  std::vector<Effect> effects(const RunSettings& run) const;

  OptionGroups requested_;
  std::vector<EffectInjector> lasers_;  // of the rig
};

}  // namespace crisp::simulate
