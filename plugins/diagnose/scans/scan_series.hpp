// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <crisp/clock_map.hpp>
#include <crisp/error.hpp>
#include <crisp/plate_trajectory.hpp>
#include <crisp/rig.hpp>
#include <crisp/scan.hpp>

namespace crisp::diagnose {

/// One received scan of a series.
struct SeriesScan {
  std::shared_ptr<const Scan> scan;
  std::int64_t count = 0;  ///< the device's counter, unwrapped, from 0
  double receipt = 0;      ///< [s] since the first reading of the actuator
  double stamp = 0;        ///< [s] device time, unwrapped, from 0

  const std::vector<float>& ranges() const { return scan->echoes.front().ranges; }
};

/// Scans of one laser and readings of the actuator, in the order of receipt.
class ScanSeries {
 public:
  void add(std::shared_ptr<const Scan> scan);  ///< scans without ranges are skipped
  void add(const PlateReading& reading);

  const std::vector<SeriesScan>& scans() const { return scans_; }
  /// φ [rad] over receipt times [s], from the raw readings. The first of several readings at one time counts.
  ///
  /// @throws Error if there are fewer than two readings at different times
  PlateTrajectory actuator(const RigPlate& plate) const;

  /// The scans that were taken with a stationary actuator. For a quarter of a second before and after such a
  /// scan, the readings agree within 2 % of the beam spacing (or two encoder steps). Held heads creep a
  /// little.
  std::vector<SeriesScan> stationary(const RigPlate& plate) const;

  /// Stamps of the scans on the hub's clock [s] by `map`, shifted below all receipt times: stamps do not
  /// identify a constant delay.
  std::vector<double> stamped(const ClockMap& map) const;

 private:
  double since_first(std::int64_t ns);

  std::optional<std::int64_t> first_ns_;
  std::vector<SeriesScan> scans_;
  std::vector<double> times_;         ///< [s] of the readings
  std::vector<std::int64_t> counts_;  ///< [steps]
};

/// There is nothing to diagnose.
Error no_actuated_scans();

}  // namespace crisp::diagnose
