// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "pipeline/data/clock_map.hpp"
#include "pipeline/data/plate_trajectory.hpp"
#include "pipeline/data/rig.hpp"
#include "pipeline/data/scan.hpp"

namespace crisp {

/// One scan of a series, as it was received.
struct SeriesScan {
  std::shared_ptr<const Scan> scan;
  std::int64_t count = 0;  ///< the device's count, unwrapped, from 0
  double receipt = 0;      ///< [s] since the first reading of the actuator
  double stamp = 0;        ///< [s] device time, unwrapped, from 0

  const std::vector<float>& ranges() const { return scan->echoes.front().ranges; }
};

/// All scans of one laser with the readings of the actuator, in the order of receipt.
class ScanSeries {
 public:
  void add(std::shared_ptr<const Scan> scan);  ///< one without ranges is passed over
  void add(const PlateReading& reading);

  const std::vector<SeriesScan>& scans() const { return scans_; }
  /// φ [rad] over receipt times [s], from the readings as they came; of several at one instant the first
  /// counts.
  /// @throws Error if there are fewer than two readings at different times
  PlateTrajectory actuator(const RigPlate& plate) const;

  /// The scans that were taken while the actuator stood still: for a quarter of a second before and after it
  /// read the same within a fiftieth of the step from beam to beam (or two steps of its encoder). Heads creep
  /// a little when they hold.
  std::vector<SeriesScan> at_rest(const RigPlate& plate) const;

  /// When the scans were stamped on the hub's clock [s], as `map` has it, put below all times of receipt:
  /// what is late by the same for all scans cannot be told from stamps.
  std::vector<double> stamped(const ClockMap& map) const;

 private:
  double since_first(std::int64_t ns);

  std::optional<std::int64_t> first_ns_;
  std::vector<SeriesScan> scans_;
  std::vector<double> times_;         ///< [s] of the readings
  std::vector<std::int64_t> counts_;  ///< [steps]
};

}  // namespace crisp
