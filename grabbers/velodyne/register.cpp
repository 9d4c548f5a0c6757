// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/velodyne/register.hpp"

#include "grabbers/velodyne/velodyne_stage.hpp"

namespace crisp::velodyne {

void register_velodyne(Registrar& registrar) { registrar.stage<VelodyneStage>(); }

}  // namespace crisp::velodyne
