// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/watch/register.hpp"

#include "plugins/calibrate/watch/watch_stage.hpp"

namespace crisp::calibrate {

void register_watch(Registrar& registrar) { registrar.stage<WatchStage>(); }

}  // namespace crisp::calibrate
