// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pipeline/stage/context.hpp"
#include "pipeline/stage/description.hpp"
#include "plugins/scans/mounting.hpp"

namespace crisp {

/// `diagnose.mounting`: whether a sweep tells where the optical centre lies off the axis.
class DiagnoseMountingStage final : public Stage {
 public:
  static void describe(StageDescription<DiagnoseMountingStage>& d);

  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  void diagnose(Findings& findings, Context& context) const;

  std::vector<double> sides_;
  ScanSeries series_;
  Findings findings_;  // what diagnoses above it said, and then its own
};

}  // namespace crisp
