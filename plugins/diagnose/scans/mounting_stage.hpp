// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crisp/context.hpp>
#include <crisp/stage.hpp>

#include "plugins/diagnose/scans/mounting.hpp"

namespace crisp::diagnose {

/// Stage `diagnose.mounting`: tests whether a sweep identifies the offset of the optical centre from the
/// axis.
class DiagnoseMountingStage final : public Stage {
 public:
  static void describe(StageDescription<DiagnoseMountingStage>& d);

  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  void diagnose(Findings& findings, Context& context) const;

  std::vector<double> sides_;
  ScanSeries series_;
  Findings findings_;  // including those of earlier stages
};

}  // namespace crisp::diagnose
