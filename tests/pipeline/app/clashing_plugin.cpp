// SPDX-License-Identifier: BSD-3-Clause
// A plugin that registers a stage of its own, and then one whose name is taken.
#include <crisp/plugin.hpp>

#include "tests/pipeline/stage/toy_stages.hpp"

namespace crisp::toy {

void register_clashing(Registrar& registrar) {
  registrar.stage<SumStage>();
  registrar.stage<CountStage>();
}

}  // namespace crisp::toy

CRISP_PLUGIN("clashing", "1.0", crisp::toy::register_clashing);
