// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include <crisp/calibration.hpp>
#include <crisp/rig.hpp>
#include <crisp/source_grabber.hpp>
#include <crisp/term.hpp>

namespace crisp {

/// A simulated scanner and its surroundings. All else is as `grabber.simulate` has it by default.
struct Simulation {
  Rig rig = default_rig();                                 ///< its lasers, and where each sits
  Calibration truth = nominal_calibration(default_rig());  ///< one laser each of the rig, in its order
  std::string scene = "office";  ///< a built-in one: office, hall, street, workshop, garden or people
  double duration = 10;          ///< [s]
  std::uint64_t seed = 1;        ///< of noise, clocks and delays
};

/// A simulated scanner as a pcl::Grabber; for its signals see SourceGrabber. Each start() plays the same
/// recording from its begin.
class SimulatorGrabber : public SourceGrabber {
 public:
  /// @param speed  times real time; 0: as fast as the callbacks take it
  /// @param terms  that `truth` names
  /// @throws Error if the speed is negative or no number, the scene is unknown, or the truth is not of the
  /// rig
  explicit SimulatorGrabber(const Simulation& simulation, double speed = 0, const TermRegistry& terms = {});
};

}  // namespace crisp
