// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/bag/register.hpp"

#include "grabbers/bag/bag_inspector.hpp"
#include "grabbers/bag/bag_stage.hpp"

namespace crisp::bag {

void register_bag(Registrar& registrar) {
  registrar.stage<BagStage>();
  registrar.inspector(bag_inspector());
}

}  // namespace crisp::bag
