// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <crisp/context.hpp>
#include <crisp/first_in_voxel.hpp>
#include <crisp/stage.hpp>

namespace crisp::filter {

/// `filter.voxel`: thins a cloud to one point in each cell of a grid.
class VoxelStage final : public Stage {
 public:
  static void describe(StageDescription<VoxelStage>& d);
  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  double size_ = 0.05;
  std::optional<Voxels> voxels_;  ///< over all clouds that come
  std::size_t too_far_ = 0;
};

}  // namespace crisp::filter
