// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/data/likeness.hpp"
#include "pipeline/stage/context.hpp"
#include "pipeline/stage/description.hpp"
#include "plugins/scans/neighbours.hpp"

namespace crisp {

/// `diagnose.sweep`: whether scans are timed better by their receipt or by the device's own clock.
class DiagnoseSweepStage final : public Stage {
 public:
  static void describe(StageDescription<DiagnoseSweepStage>& d);

  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  void diagnose(std::size_t index, Findings& findings, Context& context);

  std::optional<std::filesystem::path> folder_;
  std::vector<ScanSeries> lasers_;
  std::map<std::string, ClockMap> clocks_;
  std::vector<ToldApart> told_;
  Findings findings_;  // what diagnoses above it said, and then its own
};

}  // namespace crisp
