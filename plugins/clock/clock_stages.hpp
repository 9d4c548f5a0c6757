// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "pipeline/stage/context.hpp"
#include "pipeline/stage/description.hpp"
#include "plugins/clock/clock_aligner.hpp"

namespace crisp {

/// What the clock stages have in common: all but where a hub time comes from.
class AlignStage : public Stage {
 public:
  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 protected:
  template <class S>
  static void describe_alignment(StageDescription<S>& d);
  template <class S>
  static void describe_fit(StageDescription<S>& d);

  AlignmentSettings settings_;
  double drift_ = 200;  ///< [ppm/h]

 private:
  std::optional<ClockAligner> aligner_;
  Outputs* out_ = nullptr;  ///< of the call that is going on
};

/// `clock.convex_hull`
class ConvexHullStage final : public AlignStage {
 public:
  static void describe(StageDescription<ConvexHullStage>& d);
};

/// `clock.linear_program`
class LinearProgramStage final : public AlignStage {
 public:
  LinearProgramStage() { settings_.find = line_by_linear_program; }
  static void describe(StageDescription<LinearProgramStage>& d);
};

/// `clock.receipt`
class ReceiptStage final : public AlignStage {
 public:
  ReceiptStage() { settings_.source = TimeSource::receipt; }
  static void describe(StageDescription<ReceiptStage>& d);
};

}  // namespace crisp
