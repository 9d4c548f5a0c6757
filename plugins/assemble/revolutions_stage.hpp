// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <crisp/context.hpp>
#include <crisp/revolutions.hpp>
#include <crisp/stage.hpp>

namespace crisp::assemble {

/// `assemble.revolutions`: from the clouds of single scans to one a revolution.
class RevolutionsStage final : public Stage {
 public:
  static void describe(StageDescription<RevolutionsStage>& d);
  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  RevolutionSettings settings_;
  std::optional<Revolutions> revolutions_;
  std::uint64_t clouds_ = 0;
  Outputs* out_ = nullptr;  ///< of the call that is going on
};

}  // namespace crisp::assemble
