// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include <crisp/context.hpp>
#include <crisp/stage.hpp>

namespace crisp::telegrams {

/// `grabber.telegrams`: scans of one laser from a list of its telegrams in JSON.
class TelegramsStage final : public Stage {
 public:
  static void describe(StageDescription<TelegramsStage>& d);

  void check(const RunSettings& run) const override;
  void process(const Inputs& in, Outputs& out, Context& context) override;

 private:
  std::filesystem::path file_;
  std::string laser_;
};

}  // namespace crisp::telegrams
