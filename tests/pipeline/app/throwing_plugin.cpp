// SPDX-License-Identifier: BSD-3-Clause
// A plugin that registers a stage, and then throws what nobody expects.
#include <crisp/plugin.hpp>

#include "tests/pipeline/stage/toy_stages.hpp"

namespace crisp::toy {

void register_throwing(Registrar& registrar) {
  registrar.stage<SumStage>();
  throw 3;
}

}  // namespace crisp::toy

CRISP_PLUGIN("throwing", "1.0", crisp::toy::register_throwing);
