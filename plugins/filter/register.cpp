// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/filter/register.hpp"

#include "plugins/filter/limits_stages.hpp"
#include "plugins/filter/voxel_stage.hpp"

namespace crisp::filter {

void register_filter(Registrar& registrar) {
  registrar.stage<CropStage>();
  registrar.stage<RangeStage>();
  registrar.stage<VoxelStage>();
}

}  // namespace crisp::filter
