// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>

#include <crisp/context.hpp>
#include <crisp/stage.hpp>

namespace crisp::report {

/// `report.folder`: the page of what a run or a batch left in a folder.
class FolderReportStage final : public Stage {
 public:
  static void describe(StageDescription<FolderReportStage>& d);
  void process(const Inputs& in, Outputs& out, Context& context) override;

 private:
  std::filesystem::path folder_;
  std::optional<std::filesystem::path> file_;
  std::size_t points_ = 300'000;
  std::optional<std::filesystem::path> against_;
};

}  // namespace crisp::report
