// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include <crisp/scan.hpp>

#include "grabbers/capture/reorder_buffer.hpp"
#include "grabbers/simulate/laser_unit.hpp"
#include "grabbers/simulate/plate_unit.hpp"
#include "grabbers/simulate/recording_settings.hpp"
#include "grabbers/simulate/scene.hpp"
#include "grabbers/simulate/sweep.hpp"

namespace crisp::simulate {

/// An item received by the hub: one telegram of a laser or one encoder reading.
using HubEvent = std::variant<LaserTelegram, PlateReading>;

std::int64_t receipt_ns(const HubEvent& event);

/// Simulates what the hub receives, in the order of receipt, piece by piece: memory does not grow with the
/// duration.
class RecordingSimulator {
 public:
  /// @param scene  in the base's frame
  /// @param terms  that the true calibration names
  /// @throws Error if the settings make no sense
  RecordingSimulator(const RecordingSettings& settings, const Scene& scene, const TermRegistry& terms = {});
  RecordingSimulator(const RecordingSimulator&) = delete;
  RecordingSimulator& operator=(const RecordingSimulator&) = delete;
  ~RecordingSimulator() = default;

  /// The next event, or nothing after the last one.
  std::optional<HubEvent> next();

  const RecordingTruth& truth() const { return truth_; }
  const Motion& motion() const { return motion_; }
  /// Simulated fraction of the duration, 0 to 1.
  double progress() const;

 private:
  bool fire();  ///< simulates the next sweep or reading; false after the last one
  void hold(HubEvent event);
  /// Puts the count of an encoder that is wired to the laser into the telegram. @return its reading
  PlateReading count_into(LaserTelegram& telegram) const;

  RecordingSettings settings_;
  RecordingTruth truth_;
  Motion motion_;
  SweepSimulator sweeps_;
  Sweep upcoming_;
  std::vector<LaserUnit> lasers_;
  PlateUnit plate_;
  capture::ReorderBuffer<HubEvent> in_flight_;  ///< by receipt
  double now_ = 0;                              ///< [s] nothing is sent before it any more
};

/// The scans and readings of a whole recording.
struct SimulatedRecording {
  std::vector<Scan> scans;
  std::vector<PlateReading> readings;
  RecordingTruth truth;
};

/// Simulates a recording in memory. @throws Error as RecordingSimulator
SimulatedRecording simulate_recording(const RecordingSettings& settings, const Scene& scene,
                                      const TermRegistry& terms = {});

/// The scan of a telegram, as a capture's reader makes it.
Scan to_scan(const LaserTelegram& telegram);

}  // namespace crisp::simulate
