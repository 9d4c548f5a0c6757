// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include <crisp/context.hpp>
#include <crisp/stage.hpp>

namespace crisp::pcd_grabber {

/// `grabber.cloud`: the cloud of a PCD file of any origin.
class GrabCloudStage final : public Stage {
 public:
  static void describe(StageDescription<GrabCloudStage>& d);
  void process(const Inputs& in, Outputs& out, Context& context) override;

 private:
  std::filesystem::path file_;
  std::vector<double> shift_ = {0, 0, 0};  ///< [m]
};

}  // namespace crisp::pcd_grabber
