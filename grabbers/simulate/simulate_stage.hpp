// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <crisp/context.hpp>
#include <crisp/registrar.hpp>
#include <crisp/stage.hpp>

#include "grabbers/simulate/device_effects.hpp"
#include "grabbers/simulate/recorded_capture.hpp"
#include "grabbers/simulate/recording.hpp"
#include "grabbers/simulate/scenario.hpp"
#include "pipeline/data/degree.hpp"

namespace crisp::simulate {

/// `grabber.simulate`: simulates the hub's received data from a scanner in a known scene, and optionally
/// writes the capture and the truth.
class SimulateStage final : public Stage {
 public:
  static void describe(StageDescription<SimulateStage>& d);

  void check(const RunSettings& run) const override;
  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  using Description = StageDescription<SimulateStage>;
  static void describe_scanner(Description& d);
  static void describe_plate(Description& d);
  static void describe_lasers(Description& d);
  static void describe_stamps(Description& d);
  static void describe_links(Description& d);
  static void describe_faults(Description& d);

  // Target of the options.
  ScannerSettings& scanner() { return settings_.scanner; }
  RangeSettings& range() { return settings_.scanner.range; }
  MotionSettings& motion() { return settings_.scanner.motion; }

  RecordingSettings settings(const RunSettings& run) const;  ///< for this run, without a truth and effects

  RecordingSettings settings_;
  TruthChoice hidden_{
      .nominal_errors = {.tau = 0.02, .alpha = 3 * data::kDegree, .lambda = 5 * data::kDegree, .eta = 0.04},
      .calibration_file = {},
      .effects = {}};
  RealismChoice realism_;
  KindChoice kinds_;
  WireFaults wire_faults_;
  SceneChoice scene_;
  std::vector<std::string> silences_;
  double start_ = 1e-9 * static_cast<double>(RecordingSettings{}.start_ns);  // [s]
  std::vector<std::string> restarts_;
  std::optional<std::uint64_t> seed_;
  std::filesystem::path capture_file_;
  std::filesystem::path truth_file_;

  std::unique_ptr<RecordedCapture> capture_;
  RecordingTruth truth_;
  RecordingSettings simulated_;
  std::string simulated_scene_;
};

/// The simulator's stages.
void register_simulate(Registrar& registrar);

}  // namespace crisp::simulate
