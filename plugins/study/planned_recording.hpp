// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "grabbers/simulate/motion.hpp"
#include "grabbers/simulate/scenario.hpp"
#include "grabbers/simulate/scenario_options.hpp"

namespace crisp::study {

/// What a stage of a planned recording lets its user choose: the rig's scanner, its truth and motion, and the
/// scene.
struct PlannedRecording {
  simulate::ScannerSettings scanner;
  simulate::SceneChoice scene;
  simulate::TruthChoice truth;
  simulate::KindChoice kinds;

  /// Refuses what prepared() cannot make of the options; reads no file.
  ///
  /// @throws Errors  all that is wrong
  void check(const RunSettings& run) const;

  struct Prepared {
    simulate::ScannerSettings scanner;  ///< with the run's rig and seed, and the truth
    simulate::Scene scene;
    simulate::Motion motion;
  };
  /// @throws Error or Errors  of a file that cannot be read, as SceneChoice and TruthChoice do
  Prepared prepared(Context& context) const;
};

/// Declares the options of a planned recording.
///
/// @param way  from the stage to its PlannedRecording
template <class S, class Way>
void describe_planned(StageDescription<S>& d, Way way) {
  const auto scanner = [way](S & stage) -> auto& { return std::invoke(way, stage).scanner; };
  simulate::describe_scene(
      d, [way](S & stage) -> auto& { return std::invoke(way, stage).scene; });
  d.option("duration", scanner, &simulate::ScannerSettings::duration,
           "duration of the recording; from some ten seconds on errors decrease with its square root")
      .unit("s")
      .range(0.01, 100);
  d.option("noise", scanner, &simulate::ScannerSettings::range, &simulate::RangeSettings::sigma,
           "standard deviation of a range")
      .unit("m")
      .range(1e-6, 10);
  simulate::describe_motion(
      d, [scanner](S & stage) -> auto& { return scanner(stage).motion; });
  simulate::describe_truth(
      d, [way](S & stage) -> auto& { return std::invoke(way, stage).truth; });
  simulate::describe_field(d, scanner);
  simulate::describe_kinds(
      d, [way](S & stage) -> auto& { return std::invoke(way, stage).kinds; });
}

}  // namespace crisp::study
