// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include <crisp/context.hpp>
#include <crisp/stage.hpp>

#include "plugins/study/figures.hpp"

namespace crisp::study {

/// `study.figures`: the paper's figures 4 to 7 as data to be plotted.
class FiguresStage final : public Stage {
 public:
  static void describe(StageDescription<FiguresStage>& d);

  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  FigureSettings settings_;
  Figures figures_;
  std::filesystem::path folder_;
};

}  // namespace crisp::study
