// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>

#include <crisp/calibration.hpp>
#include <crisp/clock_aligner.hpp>
#include <crisp/context.hpp>
#include <crisp/stage.hpp>

namespace crisp::clock {

/// Common base of the clock stages: all but the source of the hub times.
class AlignStage : public Stage {
 public:
  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 protected:
  template <class S>
  static void describe_alignment(StageDescription<S>& d);
  template <class S>
  static void describe_windows(StageDescription<S>& d);
  template <class S>
  static void describe_fit(StageDescription<S>& d);
  virtual std::unique_ptr<Aligner> make_aligner(const Rig& rig, AlignmentSink sink) const;

  AlignmentSettings settings_;
  double drift_ = 200;  ///< [ppm/h]
  std::unique_ptr<Aligner> aligner_;

 private:
  Outputs* out_ = nullptr;  ///< of the call that is going on
};

/// `clock.convex_hull`
class ConvexHullStage final : public AlignStage {
 public:
  static void describe(StageDescription<ConvexHullStage>& d);
};

/// `clock.online`
class OnlineStage final : public AlignStage {
 public:
  OnlineStage() { settings_.mirror_half_width = kOnlineMirror; }
  static void describe(StageDescription<OnlineStage>& d);
  void process(const Inputs& in, Outputs& out, Context& context) override;

 protected:
  std::unique_ptr<Aligner> make_aligner(const Rig& rig, AlignmentSink sink) const override;

 private:
  void report(Context& context);
  void take_lags(const std::shared_ptr<const Calibration>& calibration);

  OnlineSettings online_;
  std::shared_ptr<const Calibration> calibration_;
  std::optional<double> reported_;  ///< [s since the epoch]
};

/// `clock.receipt`
class ReceiptStage final : public AlignStage {
 public:
  ReceiptStage() { settings_.source = TimeSource::receipt; }
  static void describe(StageDescription<ReceiptStage>& d);
};

}  // namespace crisp::clock
