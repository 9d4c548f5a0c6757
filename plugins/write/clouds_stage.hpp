// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <filesystem>

#include "pipeline/data/cloud.hpp"
#include "pipeline/pcd/pcd_table.hpp"
#include "pipeline/stage/context.hpp"
#include "pipeline/stage/description.hpp"

namespace crisp {

/// `write.clouds`: each cloud as a PCD file of its own, as soon as it comes.
class WriteCloudsStage final : public Stage {
 public:
  static void describe(StageDescription<WriteCloudsStage>& d);
  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  std::filesystem::path write(const Cloud& cloud);

  std::filesystem::path file_;
  PcdFormat format_ = PcdFormat::binary_compressed;
  std::size_t keep_ = 0;
  std::size_t written_ = 0;
  std::deque<std::filesystem::path> kept_;
  bool failed_ = false;
};

}  // namespace crisp
