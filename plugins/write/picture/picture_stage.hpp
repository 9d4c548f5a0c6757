// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include <crisp/context.hpp>
#include <crisp/stage.hpp>

#include "plugins/write/picture/points.hpp"
#include "plugins/write/picture/settings.hpp"

namespace crisp::write {

/// `write.picture`: all clouds that come, drawn into one PNG.
class WritePictureStage final : public Stage {
 public:
  static void describe(StageDescription<WritePictureStage>& d);
  void check(const RunSettings& run) const override;
  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  PictureSettings effective_settings() const;

  std::filesystem::path file_;
  PictureSettings settings_;
  std::vector<double> depth_;
  std::vector<double> centre_;
  std::optional<PicturePoints> points_;
};

}  // namespace crisp::write
