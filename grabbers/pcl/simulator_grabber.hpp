// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crisp/source_grabber.hpp>
#include <crisp/term.hpp>

#include "grabbers/simulate/recording_settings.hpp"
#include "grabbers/simulate/scene.hpp"

namespace crisp {

/// A simulated scanner as a pcl::Grabber; for its signals see SourceGrabber. Each start() plays the same
/// recording from its begin.
class SimulatorGrabber : public SourceGrabber {
 public:
  /// @param speed  times real time; 0: as fast as the callbacks take it
  /// @param terms  that the settings' true calibration names
  /// @throws Error if the speed is negative or no number, or the settings make no sense
  SimulatorGrabber(const RecordingSettings& settings, const Scene& scene, double speed = 0,
                   const TermRegistry& terms = {});

  /// The simulated truth.
  const RecordingTruth& truth() const { return truth_; }

 private:
  RecordingTruth truth_;
};

}  // namespace crisp
