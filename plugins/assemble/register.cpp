// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/assemble/register.hpp"

#include "plugins/assemble/deskew_stage.hpp"
#include "plugins/assemble/revolutions_stage.hpp"

namespace crisp::assemble {

void register_assemble(Registrar& registrar) {
  registrar.stage<DeskewStage>();
  registrar.stage<RevolutionsStage>();
}

}  // namespace crisp::assemble
