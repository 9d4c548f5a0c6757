// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/telegrams/register.hpp"

#include "grabbers/telegrams/telegrams_stage.hpp"

namespace crisp::telegrams {

void register_telegrams(Registrar& registrar) { registrar.stage<TelegramsStage>(); }

}  // namespace crisp::telegrams
