// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>

#include <crisp/context.hpp>
#include <crisp/findings.hpp>
#include <crisp/stage.hpp>

namespace crisp::write {

/// Writes the findings of a diagnosis as JSON, for programs.
class WriteFindingsStage final : public Stage {
 public:
  static void describe(StageDescription<WriteFindingsStage>& d);
  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  std::filesystem::path file_;
  std::shared_ptr<const Findings> last_;
};

}  // namespace crisp::write
