// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/watch/register.hpp"

#include "plugins/watch/watch_stage.hpp"

namespace crisp {

void register_watch(Registrar& registrar) { registrar.stage<WatchStage>(); }

}  // namespace crisp
