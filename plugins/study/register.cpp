// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/study/register.hpp"

#include "plugins/study/basin_stage.hpp"
#include "plugins/study/bound_stage.hpp"
#include "plugins/study/detection_stage.hpp"
#include "plugins/study/figures_stage.hpp"
#include "plugins/study/monte_carlo_stage.hpp"

namespace crisp::study {

void register_study(Registrar& registrar) {
  registrar.stage<BasinStage>();
  registrar.stage<BoundStage>();
  registrar.stage<DetectionStage>();
  registrar.stage<FiguresStage>();
  registrar.stage<MonteCarloStage>();
}

}  // namespace crisp::study
