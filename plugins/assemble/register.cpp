// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/assemble/register.hpp"

#include "plugins/assemble/deskew_stage.hpp"

namespace crisp {

void register_assemble(Registrar& registrar) { registrar.stage<DeskewStage>(); }

}  // namespace crisp
