// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <crisp/context.hpp>
#include <crisp/stage.hpp>

#include "pipeline/data/goodness_of_fit_tests.hpp"
#include "plugins/diagnose/scans/scan_prediction_errors.hpp"

namespace crisp::diagnose {

/// Stage `diagnose.sweep`: compares receipt times and device stamps of a sweep's scans.
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
  std::vector<data::GoodnessOfFit> reported_;
  Findings findings_;  // including those of earlier stages
};

}  // namespace crisp::diagnose
